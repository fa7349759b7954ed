"""The commands that a robot's process may lose when another process takes its place."""

from __future__ import annotations

from collections.abc import Iterable

from .commands import Command, Pause, Run, Speed, Write
from .time_state import TimeState


class PendingCommands:
    """Commands that were sent to one process, and are not known to be part of its time state or its recording.

    :param commands: those that the process begins with
    """

    def __init__(self, commands: Iterable[Command] = ()) -> None:
        self._commands = list(enumerate(commands, 1))
        self._sent = len(self._commands)

    @property
    def commands(self) -> tuple[Command, ...]:
        """In their order."""
        return tuple(command for _, command in self._commands)

    def add(self, command: Command, sent: bool = True) -> None:
        """Add a command.

        :param sent: whether it is sent now; else there is no process
        """
        self._sent += 1
        self._commands.append((self._sent, command))
        if not sent:
            self._merge(self._sent)

    def settle(self, carried_out: int, recorded: int) -> None:
        """Remove what is known.

        :param carried_out: how many commands have been carried out
        :param recorded: how many of them are part of the recording
        """
        self._commands = [
            (number, command)
            for number, command in self._commands
            if number > (carried_out if isinstance(command, Run | Pause | Speed) else recorded)
        ]
        self._merge(carried_out)

    def time_after(self, state: TimeState, next_packet_us: int) -> TimeState:
        """Return the time state after all of them."""
        for command in self.commands:
            state = state.after(command, next_packet_us)
        return state

    def _merge(self, until: int) -> None:
        """Make one of writes that come one after the other in a pause: a gamepad's would fill the memory."""
        merged: list[tuple[int, Command]] = []
        for number, command in self._commands:
            if merged and number <= until and isinstance(command, Write) and isinstance(merged[-1][1], Write):
                merged[-1] = number, Write({**merged[-1][1].writes, **command.writes})
            else:
                merged.append((number, command))
        self._commands = merged
