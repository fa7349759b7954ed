"""Find commands of the robot's own classes whose end condition is never true.

Their `isFinished` computes something; one that just returns False belongs to a command that others end. Default
commands do not count. The scheduler ends commands when the robot is disabled, so that none runs on in the next mode.
"""

from __future__ import annotations

from typing import Any

from ...project.robot_files import RobotFiles
from ...runtime.clock import Clock
from ...wpi import commands, names

#: How long a command has run that may be one.
LONG_US = 8_000_000


class UnfinishedCommands:
    """Watches the commands of one match.

    :ivar longest: how long each command has run at most, in microseconds; with the line of its `isFinished`
    :ivar finished: those that have ended because they were finished
    """

    def __init__(self, clock: Clock, files: RobotFiles) -> None:
        self.longest: dict[str, int] = {}
        self.finished: set[str] = set()
        self._clock = clock
        self._files = files
        #: Whether commands are watched.
        self.watching = False
        self._began: dict[int, tuple[Any, str, int]] = {}

    def begin(self) -> None:
        """Begin to watch if a command runs; commands2 must have been imported."""
        if not commands.scheduled_commands():
            return
        self.watching = True
        for command in commands.scheduled_commands():
            self._on_begin(command)
        commands.watch_commands(self._on_begin, self._on_finish, self._on_interrupt)

    def end(self) -> None:
        """Count the commands that run at the end of the match."""
        for command, _, _ in list(self._began.values()):
            self._on_interrupt(command)

    def _on_begin(self, command: Any) -> None:
        name = self._name_of(command)
        if name and not commands.is_default(command):
            self._began[id(command)] = command, name, self._clock.now_us

    def _on_finish(self, command: Any) -> None:
        if (began := self._began.pop(id(command), None)) is not None:
            self.finished.add(began[1])

    def _on_interrupt(self, command: Any) -> None:
        if (began := self._began.pop(id(command), None)) is not None:
            ran_us = self._clock.now_us - began[2]
            if ran_us >= LONG_US:
                self.longest[began[1]] = max(ran_us, self.longest.get(began[1], 0))

    def _name_of(self, command: Any) -> str:
        """Return the line and the name of a command's own end condition; empty if it has none."""
        condition = names.END_CONDITION
        code = getattr(getattr(type(command), condition), "__code__", None)
        if code is None or not self._files.is_robot_code(code.co_filename) or not (code.co_names or code.co_freevars):
            return ""
        place = f"{self._files.relative(code.co_filename)}:{code.co_firstlineno}"
        return f"{place}: {type(command).__name__}.{condition}()"
