"""What a front end draws: the robot at one moment of its time, and the state of the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

from ...processes.standstill import Standstill
from .commands import ChosenMode, chosen_mode
from .scene import Point, Scene

#: The state of a simulation. ``starting``: robot code is imported, or replayed to a moment of the past.
#: ``failed``: the robot crashed, hangs or has ended; `Status.failure` says how. ``closed``: nothing more will happen.
State = Literal["starting", "running", "paused", "failed", "closed"]


@dataclass(frozen=True)
class Chooser:
    """A ``SendableChooser`` that the robot has put on the dashboard.

    :param name: its place, such as ``/SmartDashboard/Auto``
    :param active: the option that the robot uses
    """

    name: str
    options: tuple[str, ...]
    default: str
    active: str


@dataclass(frozen=True)
class Opmode:
    """An opmode that the robot has published. WPILib has opmodes from 2027 on.

    :param mode: what it is for
    """

    name: str
    mode: ChosenMode
    group: str = ""
    description: str = ""


@dataclass(frozen=True)
class Snapshot:
    """The robot at one moment. Nothing in it depends on the wall clock: going back to a moment gives an equal snapshot.

    :param time: robot time, in seconds
    :param mode: the mode that the driver station asks for: ``disabled``, ``autonomous``, ``teleop``, ``test``,
        ``disabled autonomous`` or ``disabled test`` (chosen but not enabled)
    :param values: inputs and outputs by their paths in `hal_data`: ``pwm[0].value``, ``joysticks[0].axes`` (a tuple),
        ``custom["My Label"]``, ``event.game_specific_message``, ``user_program_state``, ...; only devices that
        the robot has made
    :param station_attached: whether a driver station is connected; otherwise the robot is disabled and gets no packets
    :param practice_since: when the current practice match began, in seconds
    :param match_left: the seconds left in its period, as the robot sees them
    :param distance: the distance that the robot has driven since its start, in feet
    :param mode_seconds: the time in each mode since its start
    """

    time: float
    mode: str
    scene: Scene
    values: MappingProxyType[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    choosers: tuple[Chooser, ...] = ()
    opmodes: tuple[Opmode, ...] = ()
    emergency_stopped: bool = False
    station_attached: bool = True
    practice_since: float | None = None
    match_left: float = 0.0
    distance: float = 0.0
    mode_seconds: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def enabled(self) -> bool:
        """Whether the driver station lets the robot move."""
        stopped = self.emergency_stopped or not self.station_attached
        return not self.mode.startswith("disabled") and not stopped

    @property
    def chosen_mode(self) -> ChosenMode:
        """What the robot does when it is enabled."""
        return chosen_mode(self.mode)

    @property
    def opmode(self) -> str:
        """The name of the opmode that is selected; empty for none."""
        return str(self.values.get("control.opmode") or "")


@dataclass(frozen=True)
class Failure:
    """Why the robot program has ended.

    :param headline: the user's own file and line first, as ``robot.py:12: ZeroDivisionError: division by zero``
    :param details: the traceback, if there is one
    :param time: robot time, in seconds
    :param exit_code: the command's exit code: 1 when the robot's code failed, 2 when it cannot be run
    """

    headline: str
    details: str
    time: float
    exit_code: int = 1

    def __str__(self) -> str:
        return f"failed at {self.time:.2f} s: {self.headline}"


@dataclass(frozen=True)
class Status:
    """The state of the simulation: what depends on this machine, and not on the robot alone.

    :param speed: the wanted speed in robot seconds per second; 0 is as fast as possible
    :param reached: the measured speed over about the last half second
    :param average: the measured speed since the robot started, without pauses
    :param packet_seconds: the time that this machine took for the last packet, in wall seconds
    :param worst_packet_seconds: the longest such time in about the last second
    :param late_packets: the number of packets that took longer than 20 ms
    :param overruns: the number of turns of the robot's loop that took longer than its period, in robot time
    :param worst_loop_seconds: the longest of those turns, in seconds of robot time
    :param length: the end of the recording, in seconds of robot time; going back to any moment before it is possible
    :param failure: the reason, while `state` is ``failed``
    :param note: information for the user, such as why a command was not carried out
    :param responding: False while the robot should run and its process has sent nothing for a second
    :param standstill: where the robot's code stands meanwhile, if that is known
    :param former_trail: the robot's path before the code changed or the user went back in time
    :param starts: the number of robot processes that were started
    :param replayed: how far the robot has come, in seconds of robot time, while it replays its inputs to `replaying_to`
    :param replaying_to: 0: it replays nothing
    :param network_address: the address of the NetworkTables server, if there is one
    """

    state: State = "starting"
    speed: float = 1.0
    reached: float = 0.0
    average: float = 0.0
    packet_seconds: float = 0.0
    worst_packet_seconds: float = 0.0
    late_packets: int = 0
    overruns: int = 0
    worst_loop_seconds: float = 0.0
    length: float = 0.0
    failure: Failure | None = None
    note: str = ""
    responding: bool = True
    standstill: Standstill | None = None
    former_trail: tuple[Point, ...] = ()
    network_address: str | None = None
    starts: int = 0
    replayed: float = 0.0
    replaying_to: float = 0.0
