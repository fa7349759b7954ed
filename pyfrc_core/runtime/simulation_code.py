"""Which code runs in simulations only: ``physics.py``, and what WPILib calls to simulate."""

from __future__ import annotations

from types import FrameType

from ..compat.cpython_private import outwards
from ..wpi import names

_PHYSICS = "physics.py"


def is_of_simulation(frame: FrameType | None) -> bool:
    """Return whether simulation code has called what runs in this frame."""
    codes = (call.f_code for call in outwards(frame))
    return any(code.co_name in names.OF_SIMULATION or code.co_filename.endswith(_PHYSICS) for code in codes)
