"""What a front end draws: the robot at one moment of its time, and how the simulation of it goes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

from .scene import Point, Scene

#: How a simulation stands. ``starting``: robot code is imported, or brought to a moment of the past.
#: ``failed``: the robot crashed, hangs or has ended; `Status.failure` says how. ``closed``: nothing comes any more.
State = Literal["starting", "running", "paused", "failed", "closed"]


@dataclass(frozen=True)
class Chooser:
    """A ``SendableChooser`` that the robot has put on the dashboard.

    :param name: where, such as ``/SmartDashboard/Auto``
    :param active: the option that the robot goes by
    """

    name: str
    options: tuple[str, ...]
    default: str
    active: str


@dataclass(frozen=True)
class Snapshot:
    """The robot at one moment. The same whenever this moment comes again: nothing in it depends on the wall clock.

    :param time: robot time, in seconds
    :param mode: what the driver station asks for: ``disabled``, ``autonomous``, ``teleop``, ``test``,
        ``disabled autonomous`` or ``disabled test`` (chosen, and not enabled)
    :param values: inputs and outputs by their paths in `hal_data`: ``pwm[0].value``, ``joysticks[0].axes`` (a tuple),
        ``custom["My Label"]``, ``event.game_specific_message``, ``user_program_state``, ...; of devices, only those
        that the robot has made
    :param station_attached: whether there is a driver station; without one, the robot is disabled and gets no packets
    :param practice_since: when the practice match began that goes on now, in seconds
    :param match_left: the seconds left in its period, as told to the robot
    :param distance: how far the robot has driven since its start, in feet
    :param mode_seconds: how long it has been in each mode since its start
    """

    time: float
    mode: str
    scene: Scene
    values: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    choosers: tuple[Chooser, ...] = ()
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
    def chosen_mode(self) -> str:
        """``autonomous``, ``teleop`` or ``test``: what the robot does when it is enabled."""
        if self.mode == "disabled":
            return "teleop"
        return self.mode.removeprefix("disabled ")


@dataclass(frozen=True)
class Failure:
    """Why the robot program runs no more.

    :param headline: the user's own file and line first, as ``robot.py:12: ZeroDivisionError: division by zero``
    :param details: the traceback, if there is one
    :param time: robot time, in seconds
    :param exit_code: a command's: 1 when the robot's code failed, 2 when there is no way to run it
    """

    headline: str
    details: str
    time: float
    exit_code: int = 1


@dataclass(frozen=True)
class Status:
    """How the simulation goes: what depends on this machine, and not on the robot alone.

    :param speed: robot seconds a second, as asked for; 0 is as fast as it goes
    :param reached: robot seconds a second, over the last half second or so
    :param average: the same since the robot was there, without pauses
    :param packet_seconds: how long this machine took to compute the last packet, in wall seconds
    :param worst_packet_seconds: the longest of the last second or so
    :param late_packets: how many packets have taken longer than 20 ms to compute
    :param overruns: how many turns of the robot's loop took longer than its period, in robot time
    :param worst_loop_seconds: the longest of those turns, in seconds of robot time
    :param length: how far the recording goes, in seconds of robot time: one can go back to any moment until then
    :param failure: what has happened, while `state` is ``failed``
    :param note: something that the user should know, such as why a command was not carried out
    :param responding: whether the robot's process has been heard of in the last second, while it should run
    :param former_trail: where the robot drove before the code was changed, or time turned back
    :param starts: how many robot processes have been started until now
    :param network_address: where dashboards find NetworkTables, if they are served
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
    former_trail: tuple[Point, ...] = ()
    network_address: str | None = None
    starts: int = 0
