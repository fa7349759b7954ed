"""The messages between a simulation and its robot's process, besides commands: pickled dataclasses.

The paths of NetworkTables, of the pose and of the mode are those that `hal_data` does not have.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ...project import Project
from ...runtime.scripts.script import InputScript, Step
from ...runtime.scripts.trace_lines import Change
from .commands import ChosenMode, Command, TimeState
from .options import SimOptions
from .scene import Line, Point, Pose, Tag, Target, Text
from .snapshot import Chooser, Failure, Opmode

#: What the path of a value of NetworkTables begins with, as in input scripts; and that of a topic's type.
VALUE, TYPE = "nt:", "type:"
#: The mode that the driver station asks for, as in `Snapshot.mode`; the robot's place: x, y and angle as in `Pose`.
MODE, POSE = "sim.mode", "sim.pose"
#: The mode of a robot elsewhere: while there is no connection to it, and when it does not say what it is.
NO_CONNECTION, UNKNOWN_MODE = "no connection", "unknown mode"


@dataclass(frozen=True)
class StationState:
    """The state of the driver station that the robot does not have.

    :param practice_since_us: when the current practice match began
    :param sticks: the state of the joysticks' controls, by target, whether or not the robot receives it
    :param opmodes: the names of the opmodes that were chosen, by mode; an empty one: none is to run
    :param taps: the controls that were released before a packet had shown the robot that they were pressed, with the
        number of packets until they are released for the robot
    """

    practice_since_us: int | None = None
    sticks: Mapping[str, Any] = field(default_factory=dict)
    opmodes: Mapping[ChosenMode, str] = field(default_factory=dict)
    taps: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Job:
    """One run of the robot, for its process.

    :param script: the robot's inputs, from its start on
    :param forward_to_us: the moment to replay to, as fast as possible
    :param time_state: the state of time from there on
    :param commands: carried out there, before time goes on
    :param station: the driver station at `forward_to_us`
    :param tags: the field's tags, if they are known already
    :param reports_replay: whether to report what the robot does in the replay: its code has changed since
    """

    project: Project
    options: SimOptions
    script: InputScript
    forward_to_us: int = 0
    time_state: TimeState = field(default_factory=TimeState)
    commands: tuple[Command, ...] = ()
    station: StationState = StationState()
    tags: tuple[Tag, ...] | None = None
    reports_replay: bool = False


@dataclass(frozen=True, kw_only=True)
class RobotReport:
    """What the robot did since the last report.

    :param time_us: robot time
    :param base: all values of `hal_data`, where `changes` do not continue those sent before
    :param changes: the new changes of `hal_data`
    :param network_base: all values of NetworkTables, together with `base`; see `robot_side.traces`
    :param network_changes: the new changes of NetworkTables
    """

    time_us: int
    base: Mapping[str, Any] | None = None
    changes: tuple[Change, ...] = ()
    network_base: Mapping[str, Any] | None = None
    network_changes: tuple[Change, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Replayed(RobotReport):
    """How far the robot has come on its way to the moment that it goes on from. Known changes are left out."""


@dataclass(frozen=True)
class Ready:
    """The robot has reached the moment that it goes on from.

    :param libraries: the modules that its code has imported and that are not its own
    :param network_address: where NetworkTables are served
    :param notes: information for the user
    """

    tags: tuple[Tag, ...]
    libraries: tuple[str, ...]
    network_address: str | None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Update(RobotReport):
    """What has changed since the last one.

    :param time_state: the state of time
    :param carried_out: the number of commands that were carried out, including those of the `Job`
    :param recorded: how many of them are in the recorded steps; a command in a pause is recorded when time goes on
    :param trail: the robot's places since the last update
    :param distance: the whole distance that it has driven, in feet
    :param mode_seconds: the time that it has been in each mode
    :param steps: recorded steps; the first has the number `steps_from`
    :param drawings: the user's drawings, if they have changed; `targets`, `choosers` and `opmodes` likewise
    """

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
    trail: tuple[Point, ...]
    distance: float
    mode_seconds: Mapping[str, float]
    steps_from: int
    steps: tuple[Step, ...]
    drawings: tuple[Line | Text, ...] | None
    targets: tuple[Target, ...] | None
    choosers: tuple[Chooser, ...] | None
    opmodes: tuple[Opmode, ...] | None
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Failed:
    """The robot program has failed, and its process ends."""

    failure: Failure


@dataclass(frozen=True)
class WindowClosed:
    """The user has closed WPILib's window."""


Message = Replayed | Ready | Update | Failed | WindowClosed
