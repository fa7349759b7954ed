"""The commands that a simulation sends to its robot's process; `Simulation`'s methods make them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

ChosenMode = Literal["autonomous", "teleop", "test"]


@dataclass(frozen=True)
class Run:
    """Let time go on.

    :param until_us: pause at this robot time; None: never
    :param packets: pause after this many packets
    """

    until_us: int | None = None
    packets: int | None = None


@dataclass(frozen=True)
class Pause:
    """Pause."""


@dataclass(frozen=True)
class Speed:
    """Set the robot seconds per second; 0 is as fast as possible."""

    factor: float


@dataclass(frozen=True)
class ChooseMode:
    """Disable the robot, and choose the mode for when it is enabled. Ends a practice match."""

    mode: ChosenMode


@dataclass(frozen=True)
class Enable:
    """Enable the robot in the chosen mode, or disable it. Disabling ends a practice match."""

    enabled: bool


@dataclass(frozen=True)
class EmergencyStop:
    """Stop the robot; it can be enabled again only after its program was restarted."""


@dataclass(frozen=True)
class Practice:
    """Begin a practice match, with the periods of the project's settings."""


@dataclass(frozen=True)
class Write:
    """Change inputs: values by target, as in input scripts (see `pyfrc_core.runtime.scripts.targets`)."""

    writes: Mapping[str, Any]


@dataclass(frozen=True)
class Quit:
    """End; for a robot's process and for its host."""


Command = Run | Pause | Speed | ChooseMode | Enable | EmergencyStop | Practice | Write

#: The target that moves the robot on the field: x, y and angle as WPILib has them, in metres and degrees.
ROBOT_ON_FIELD = "nt:/SmartDashboard/Field/Robot"


def chooser_target(chooser: str) -> str:
    """Return the target that selects a chooser's option."""
    return f"nt:{chooser}/selected"
