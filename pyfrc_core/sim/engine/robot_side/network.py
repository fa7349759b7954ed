"""NetworkTables of a simulated robot: the values that dashboards show and write, and choosers.

The robot's own tables stay in its process, where nothing changes them while the robot's code runs. A second instance
serves dashboards, and between packets the changes of each are copied to the other. So a dashboard's write arrives at a
moment that can be recorded, and at the same moment in a replay.
"""

from __future__ import annotations

import errno
import socket
from collections.abc import Callable
from typing import Any

from ....runtime.scripts.network_targets import NETWORK
from ....wpi import dashboards, network
from ..choosers import TABLE_TYPE, chooser_at
from ..snapshot import Chooser


def written_target(target: str) -> str:
    """Return the target that changes what another one shows.

    :raises UsageError: when a dashboard cannot change it
    """
    return NETWORK + dashboards.written_entry(target.removeprefix(NETWORK)) if target.startswith(NETWORK) else target


class Choosers:
    """The choosers among the robot's own tables."""

    def __init__(self) -> None:
        self._news = network.listen_for_names()
        self._names: set[str] = set()
        self._sent: tuple[Chooser, ...] = ()

    def changed(self) -> tuple[Chooser, ...] | None:
        """Return all choosers; None when nothing has changed since the last call."""
        for published in self._news.read():
            if published.name.endswith(TABLE_TYPE):
                self._names.add(published.name.removesuffix(TABLE_TYPE))
        choosers = tuple(filter(None, (chooser_at(network.value_of, name) for name in sorted(self._names))))
        if choosers == self._sent:
            return None
        self._sent = choosers
        return choosers


class Served:
    """The robot's tables, served to dashboards.

    Who connects can change every value, and needs no key: by default, only this computer's dashboards can.

    :param shared: whether dashboards on other computers can connect
    :param write: writes a target, as in input scripts
    """

    def __init__(self, port: int, shared: bool, write: Callable[[str, object], object]) -> None:
        self._write = write
        self._robot = network.listen_for_values(current=True)
        self._from_outside: dict[str, Any] = {}
        listen = "" if shared else "127.0.0.1"
        self.problem = _problem_with(listen, port)
        self.address = None if self.problem else f"localhost:{port}"
        self._server = network.NetworkServer(None if self.problem else listen, port)

    def exchange(self) -> None:
        """Copy what the robot has published to dashboards, and what dashboards have written to the robot."""
        for update in self._robot.read():
            if update.name in self._from_outside and self._from_outside.pop(update.name) == update.value:
                continue  # a dashboard's own write comes back
            self._server.publish(update)
        for update in self._server.written.read():
            if _is_plain(update.value):
                self._from_outside[update.name] = update.value
                self._write(f"{NETWORK}{update.name}", update.value)

    def close(self) -> None:
        """Release the port."""
        self._server.close()


def _is_plain(value: Any) -> bool:
    """Return whether a dashboard may write this: only robots write structs and the like."""
    items = value if isinstance(value, list) else [value]
    return all(isinstance(each, (bool, int, float, str)) for each in items)


def _problem_with(listen: str, port: int) -> str | None:
    """Return why no server is possible at this port, which WPILib would only print to the console."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((listen, port))
        except OSError as error:
            taken = error.errno == errno.EADDRINUSE
            why = "is taken. Is another simulation running?" if taken else f"cannot be had: {error.strerror}"
            return f"Dashboards cannot connect: port {port} {why}"
    return None
