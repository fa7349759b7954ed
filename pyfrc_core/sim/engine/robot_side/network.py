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

import ntcore

from ....runtime.scripts.network_entries import NETWORK
from ..snapshot import Chooser

_PUBLISHED = int(ntcore.EventFlags.kPublish) | int(ntcore.EventFlags.kImmediate)
_VALUES = int(ntcore.EventFlags.kValueAll) | int(ntcore.EventFlags.kImmediate)
_FROM_OUTSIDE = int(ntcore.EventFlags.kValueRemote)
_CHOOSER, _TYPE = "String Chooser", "/.type"


class Choosers:
    """The choosers among the robot's own tables."""

    def __init__(self) -> None:
        self._instance = ntcore.NetworkTableInstance.getDefault()
        self._news = ntcore.NetworkTableListenerPoller(self._instance)
        self._news.addListener([""], _PUBLISHED)
        self._names: set[str] = set()
        self._sent: tuple[Chooser, ...] = ()

    def changed(self) -> tuple[Chooser, ...] | None:
        """Return all choosers; None when nothing has changed since the last call."""
        for event in self._news.readQueue():
            name = event.data.name if isinstance(event.data, ntcore.TopicInfo) else ""
            if name.endswith(_TYPE):
                self._names.add(name.removesuffix(_TYPE))
        choosers = tuple(self._chooser(name) for name in sorted(self._names) if self._text(name + _TYPE) == _CHOOSER)
        if choosers == self._sent:
            return None
        self._sent = choosers
        return choosers

    def _chooser(self, name: str) -> Chooser:
        options = self._instance.getEntry(f"{name}/options").getStringArray([])
        return Chooser(name, tuple(options), self._text(f"{name}/default"), self._text(f"{name}/active"))

    def _text(self, name: str) -> str:
        return str(self._instance.getEntry(name).getString(""))


class Served:
    """The robot's tables, served to dashboards.

    Who connects can change every value, and needs no key: by default, only this computer's dashboards can.

    :param shared: whether dashboards on other computers can connect
    :param write: writes a target, as in input scripts
    """

    def __init__(self, port: int, shared: bool, write: Callable[[str, object], object]) -> None:
        self._write = write
        self._robot = ntcore.NetworkTableListenerPoller(ntcore.NetworkTableInstance.getDefault())
        self._robot.addListener([""], _VALUES)
        self._instance = ntcore.NetworkTableInstance.create()
        self._publishers: dict[str, tuple[str, ntcore.GenericPublisher]] = {}
        self._from_outside: dict[str, Any] = {}
        listen = "" if shared else "127.0.0.1"
        self.problem = _problem_with(listen, port)
        self.address = None if self.problem else f"localhost:{port}"
        if self.problem is None:
            self._instance.startServer("", listen, 0, port)
        self._news = ntcore.NetworkTableListenerPoller(self._instance)
        self._news.addListener([""], _FROM_OUTSIDE)

    def exchange(self) -> None:
        """Copy what the robot has published to dashboards, and what dashboards have written to the robot."""
        for event in self._robot.readQueue():
            data = event.data
            if isinstance(data, ntcore.ValueEventData):
                self._publish(data.topic, data.value)
        for event in self._news.readQueue():
            data = event.data
            if isinstance(data, ntcore.ValueEventData) and (value := _plain(data.value)) is not None:
                name = data.topic.getName()
                self._from_outside[name] = value
                self._write(f"{NETWORK}{name}", value)

    def close(self) -> None:
        """Release the port."""
        ntcore.NetworkTableInstance.destroy(self._instance)

    def _publish(self, topic: ntcore.Topic, value: ntcore.Value) -> None:
        name = topic.getName()
        if name in self._from_outside and self._from_outside.pop(name) == value.value():
            return  # a dashboard's own write comes back
        kind = topic.getTypeString()
        known = self._publishers.get(name)
        if known is None or known[0] != kind:
            served = self._instance.getTopic(name)
            self._publishers[name] = known = (kind, served.genericPublish(kind))
            served.setProperties(topic.getProperties())
        known[1].set(value)


def _plain(value: ntcore.Value) -> Any:
    found = value.value()
    items = found if isinstance(found, (list, tuple)) else [found]
    if not all(isinstance(each, (bool, int, float, str)) for each in items):
        return None  # only robots write structs and the like
    return list(found) if isinstance(found, tuple) else found


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
