"""What a log measured, as targets of input scripts: ``hold:encoder[0].count``, ``hold:nt:/limelight/tx``.

The robot's process holds them there (`held`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from ...compat.unrepeatable import in_real_time
from ...hal.rows import role_of
from .network_targets import NETWORK

HOLD = "hold:"
#: An encoder's period when it stands: JSON has no word for it.
INFINITE = "inf"

#: Where cameras publish: Limelight, PhotonVision.
_OF_CAMERA = re.compile(r"/(limelight[^/]*|photonvision/[^/]+)/.+", re.DOTALL)


def camera_of(name: str) -> str | None:
    """Return the camera that an entry of NetworkTables is of, such as ``limelight``; None if it is of none."""
    found = _OF_CAMERA.fullmatch(name)
    return None if found is None else found[1]


def is_sensor(path: str) -> bool:
    """Return whether a path in `hal_data` is of a value that a device measures."""
    return role_of(path) == "measured" and not in_real_time(path)


def released(values: Mapping[str, object]) -> dict[str, object]:
    """Return the writes that leave to physics what is held after these writes."""
    return {target: None for target, value in values.items() if target.startswith(HOLD) and value is not None}


def written_once(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return these writes without those that hold a sensor; what cameras measured is written, but not held.

    For runs that go on without the log: there, physics moves the sensors.
    """
    camera = HOLD + NETWORK
    return {
        target.removeprefix(HOLD): value
        for target, value in values.items()
        if not target.startswith(HOLD) or (target.startswith(camera) and value is not None)
    }
