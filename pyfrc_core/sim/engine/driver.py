"""One of those who drive a simulation: what they hold is released when they leave, as when a page is closed."""

from __future__ import annotations

import threading
from collections.abc import Callable

from ...runtime.scripts.joysticks import releases
from .commands import Command, Write
from .controls import Controls

#: Held while a driver comes or leaves: of two that leave, one is the last.
_coming_or_leaving = threading.Lock()


class Driver(Controls):
    """The controls of one person. A robot that the last person has left is disabled, as without a driver station.

    :param send: sends a command to the robot's process
    :param drivers: all who drive the same robot
    """

    def __init__(self, send: Callable[[Command], object], drivers: set[Driver]) -> None:
        self._pass_on, self._drivers = send, drivers
        #: The writes that release what is held, by target.
        self._releases: dict[str, object] = {}
        with _coming_or_leaving:
            drivers.add(self)

    def leave(self) -> None:
        """Release what is held, and disable the robot if no other driver is left."""
        if self._releases:
            self.write(self._releases)
        with _coming_or_leaving:
            self._drivers.discard(self)
            is_last = not self._drivers
        if is_last:
            self.disable()

    def _send(self, command: Command) -> None:
        if isinstance(command, Write):
            held = releases(command.writes)
            self._releases = {target: value for target, value in self._releases.items() if target not in command.writes}
            self._releases |= held
        self._pass_on(command)
