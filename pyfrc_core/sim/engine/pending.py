"""The commands that would be lost when another process replaces the robot's process."""

from __future__ import annotations

from collections.abc import Iterable

from .commands import Command, Pause, Run, Speed, Write
from .time_state import TimeState


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
            if number > (carried_out if isinstance(command, Run | Pause | Speed) else recorded)
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
