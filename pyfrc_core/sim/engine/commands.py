"""What a simulation tells its robot's process; `Simulation`'s methods make these."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

ChosenMode = Literal["autonomous", "teleop", "test"]


@dataclass(frozen=True)
class Run:
    """Let time go on.

    :param until_us: pause when robot time gets there; None: never
    :param packets: pause after so many packets
    """

    until_us: int | None = None
    packets: int | None = None


@dataclass(frozen=True)
class Pause:
    """Let time stand still."""


@dataclass(frozen=True)
class Speed:
    """Robot seconds a second; 0 is as fast as it goes."""

    factor: float


@dataclass(frozen=True)
class ChooseMode:
    """Disable the robot, and have this ready for when it is enabled. Ends a practice match."""

    mode: ChosenMode


@dataclass(frozen=True)
class Enable:
    """Enable the robot in the chosen mode, or disable it. Disabling ends a practice match."""

    enabled: bool


@dataclass(frozen=True)
class EmergencyStop:
    """Stop the robot for good: it can be enabled again only when its program has been restarted."""


@dataclass(frozen=True)
class Practice:
    """Begin a practice match, with the periods of the project's settings."""


@dataclass(frozen=True)
class Write:
    """Change inputs: values by target, as in input scripts (see `pyfrc_core.runtime.scripts.targets`)."""

    writes: Mapping[str, Any]


@dataclass(frozen=True)
class Quit:
    """End; told to a robot's process, and to its host."""


Command = Run | Pause | Speed | ChooseMode | Enable | EmergencyStop | Practice | Write

#: The target that puts the robot elsewhere on the field: x, y and angle as WPILib has them, in metres and degrees.
ROBOT_ON_FIELD = "nt:/SmartDashboard/Field/Robot"


def chooser_target(chooser: str) -> str:
    """Return the target that selects a chooser's option."""
    return f"nt:{chooser}/selected"
