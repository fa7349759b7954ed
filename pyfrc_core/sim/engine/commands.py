"""The commands that a simulation sends to its robot's process; `Simulation`'s methods make them.

`TimeState` is what the commands about time add up to. `PendingCommands` would be lost when another process replaces the
robot's process.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal, cast

from ...runtime.robot_time import PACKET_US
from ...season import CURRENT

#: What a robot does when it is enabled.
ChosenMode = Literal["autonomous", "teleop", "test"]


def chosen_mode(mode: str) -> ChosenMode:
    """Return what the robot does in one of the modes of input scripts, or when it is enabled in it."""
    return cast(ChosenMode, mode.removeprefix("disabled").strip() or "teleop")


@dataclass(frozen=True)
class Resume:
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
class ChooseOpmode:
    """Choose an opmode for its mode, which may be another one than the chosen mode. It disables a robot in this mode.

    :param name: empty: none
    """

    name: str
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


Command = Resume | Pause | Speed | ChooseMode | ChooseOpmode | Enable | EmergencyStop | Practice | Write

#: The target that moves the robot on the field.
ROBOT_ON_FIELD = CURRENT.dashboards.robot_on_field


def chooser_target(chooser: str) -> str:
    """Return the target that selects a chooser's option."""
    return f"nt:{chooser}/{CURRENT.dashboards.choice}"


@dataclass(frozen=True)
class TimeState:
    """Changes by commands and by reaching `until_us` only.

    The robot's process follows it. The `Simulation` computes from it what the user wants, however far the process is.

    :param until_us: pause when robot time gets there; None: never
    :param stepping: whether `until_us` is the end of a step
    :param speed: robot seconds per second; 0 is as fast as possible
    """

    paused: bool = False
    until_us: int | None = None
    stepping: bool = False
    speed: float = 1.0

    def after(self, command: Command, next_packet_us: int) -> TimeState:
        """Return the state after a command, which need not be one about time.

        A step that comes before the end of another is added to it, so that the machine's speed makes no difference.

        :param next_packet_us: when the first packet after the command is due
        """
        match command:
            case Resume(packets=int(packets)):
                begin_us = self.until_us if self.stepping and self.until_us is not None else next_packet_us - PACKET_US
                return replace(self, paused=False, until_us=begin_us + packets * PACKET_US, stepping=True)
            case Resume():
                return replace(self, paused=False, until_us=command.until_us, stepping=False)
            case Pause():
                return self.stopped()
            case Speed():
                return replace(self, speed=command.factor)
            case _:
                return self

    def stopped(self) -> TimeState:
        """Return the paused state, after `Pause` or at `until_us`."""
        return replace(self, paused=True, until_us=None, stepping=False)

    def continued_at(self, time_us: int) -> TimeState:
        """Return the state after going to another moment. It ends a step; a later `until_us` stays."""
        if self.paused or self.stepping or (self.until_us is not None and self.until_us <= time_us):
            return self.stopped()
        return self


class PendingCommands:
    """Commands that were sent to a process and are not yet part of the time state or recording that it reported.

    :param commands: the commands that the process begins with
    """

    def __init__(self, commands: Iterable[Command] = ()) -> None:
        self._commands = list(enumerate(commands, 1))
        self._sent = len(self._commands)

    @property
    def commands(self) -> tuple[Command, ...]:
        """The commands, in their order."""
        return tuple(command for _, command in self._commands)

    def add(self, command: Command, sent: bool = True) -> None:
        """Add a command.

        :param sent: whether it is sent now; False where there is no process
        """
        self._sent += 1
        self._commands.append((self._sent, command))
        if not sent:
            self._merge(self._sent)

    def settle(self, carried_out: int, recorded: int) -> None:
        """Remove the commands that the process has reported.

        :param carried_out: the number of commands that were carried out
        :param recorded: the number of them that are in the recording
        """
        self._commands = [
            (number, command)
            for number, command in self._commands
            if number > (carried_out if isinstance(command, Resume | Pause | Speed) else recorded)
        ]
        self._merge(carried_out)

    def time_after(self, state: TimeState, next_packet_us: int) -> TimeState:
        """Return the time state after all these commands."""
        for command in self.commands:
            state = state.after(command, next_packet_us)
        return state

    def _merge(self, until: int) -> None:
        """Merge consecutive writes in a pause into one: those of a gamepad would fill the memory."""
        merged: list[tuple[int, Command]] = []
        for number, command in self._commands:
            if merged and number <= until and isinstance(command, Write) and isinstance(merged[-1][1], Write):
                merged[-1] = number, Write({**merged[-1][1].writes, **command.writes})
            else:
                merged.append((number, command))
        self._commands = merged
