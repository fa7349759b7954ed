"""What a robot prints, read from its console service, as `pyfrc console` does."""

from __future__ import annotations

import threading
from collections.abc import Callable

from ...deploy.console import ConnectionReports, lines_of_one_connection
from ...deploy.discovery import Address
from ...deploy.errors import NoConsoleError

#: How long to wait before the next connection, in seconds.
_BETWEEN_SECONDS = 2.0


class RobotConsole:
    """Reads one robot's console, on a thread of its own, until it is closed.

    A roboRIO sends its output only while a Driver Station is connected to it. None is imitated here.

    :param add: called with each line
    :param say: called once with a sentence, if there is no console
    """

    def __init__(self, address: Address, add: Callable[[str], object], say: Callable[[str], object]) -> None:
        self.address = address
        self._add, self._say = add, say
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._follow, name="pyfrc view: robot's console", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End."""
        self._over.set()
        self._thread.join()

    def _follow(self) -> None:
        report = ConnectionReports(quiet=True)
        is_known = False
        while not self._over.is_set():
            try:
                for line in lines_of_one_connection(self.address, False, report, self._over.is_set):
                    is_known = True
                    self._add(f"{line}\n")
            except NoConsoleError:
                return
            if not is_known and "connected" not in report.made and not self._over.is_set():
                self._say(f"What the robot prints is not shown: there is no console at {self.address}.")
            is_known = True
            self._over.wait(_BETWEEN_SECONDS)
