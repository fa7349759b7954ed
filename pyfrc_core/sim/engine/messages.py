"""What goes between a simulation and its robot's process, besides commands: pickled dataclasses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...project import Project
from ...runtime.scripts.script import InputScript, Step
from .commands import Command
from .scene import Line, Point, Pose, Tag, Target, Text
from .snapshot import Chooser, Failure
from .time_state import TimeState


@dataclass(frozen=True)
class StationState:
    """What a driver station knows that its robot does not.

    :param practice_since_us: when the practice match began that goes on now
    :param sticks: what the joysticks' controls are at, by target, whether or not it is delivered to the robot
    """

    practice_since_us: int | None = None
    sticks: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Job:
    """One run of the robot, for its process.

    :param script: what the robot is told from outside, from its start on
    :param forward_to_us: how far to go at once, as fast as it goes
    :param time_state: how time is to go on from there
    :param commands: to be carried out there, before time goes on
    :param recording: whether what comes from outside is to be told, and what the robot does packet by packet
    :param station: how the driver station is at `forward_to_us`
    :param nt_port: where to serve NetworkTables to dashboards; None: nowhere
    :param wpilog: where to write WPILib's data log
    :param extensions: WPILib's simulation extensions to load, by name
    :param tags: the field's tags, if it is known already which there are
    """

    project: Project
    script: InputScript
    forward_to_us: int = 0
    time_state: TimeState = field(default_factory=TimeState)
    commands: tuple[Command, ...] = ()
    recording: bool = True
    station: StationState = StationState()
    nt_port: int | None = None
    wpilog: Path | None = None
    extensions: tuple[str, ...] = ()
    tags: tuple[Tag, ...] | None = None


@dataclass(frozen=True)
class Ready:
    """The robot has been brought to where it is to go on from.

    :param libraries: the modules that its code has imported and that are not its own
    :param network_address: where NetworkTables are served
    :param notes: what the user should know
    """

    tags: tuple[Tag, ...]
    libraries: tuple[str, ...]
    network_address: str | None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Update:
    """What has changed since the last one.

    :param time_us: robot time
    :param time_state: how robot time goes on
    :param carried_out: how many commands have been carried out, those of the `Job` among them
    :param recorded: how many of them are part of the recorded steps: what comes in a pause is when time goes on
    :param base: all values of `hal_data`, where `lines` do not go on from those told before
    :param lines: of the trace (see `pyfrc_core.runtime.trace`), the lines since then
    :param trail: where the robot has been since then
    :param distance: how far it has driven in all, in feet
    :param mode_seconds: how long it has been in each mode
    :param steps: recorded steps, from the one with the number `steps_from`
    :param drawings: the user's drawings, if they have changed; likewise `targets`, `choosers`
    """

    time_us: int
    mode: str
    station: StationState
    time_state: TimeState
    carried_out: int
    recorded: int
    reached: float
    average: float
    packet_seconds: float
    worst_packet_seconds: float
    late_packets: int
    overruns: int
    worst_loop_seconds: float
    robot: Pose | None
    base: Mapping[str, Any] | None
    lines: tuple[str, ...]
    trail: tuple[Point, ...]
    distance: float
    mode_seconds: Mapping[str, float]
    steps_from: int
    steps: tuple[Step, ...]
    drawings: tuple[Line | Text, ...] | None
    targets: tuple[Target, ...] | None
    choosers: tuple[Chooser, ...] | None
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Failed:
    """The robot program runs no more; its process ends."""

    failure: Failure


@dataclass(frozen=True)
class WindowClosed:
    """The user has closed WPILib's window."""


Message = Ready | Update | Failed | WindowClosed
