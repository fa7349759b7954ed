"""A client of another program's NetworkTables: those of a robot, or of a simulation in another process."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import ntcore

from ..network_news import Connected, Gone, Lost, News, Received
from .network import value_of_type, written_entry

#: How often the server sends what has changed, in seconds: all values that changed meanwhile, not the last one only.
_INTERVAL = 0.02
_TOPICS = int(ntcore.EventFlags.kPublish) | int(ntcore.EventFlags.kUnpublish)
_VALUES = int(ntcore.EventFlags.kValueAll)
_LOCAL, _GONE = int(ntcore.EventFlags.kValueLocal), int(ntcore.EventFlags.kUnpublish)
_CONNECTED = int(ntcore.EventFlags.kConnected)


class Client:
    """Connects to the first server that responds, and again when the connection is lost.

    :param name: what the server knows this client by
    :param servers: hosts and ports
    :param asks_driver_station: whether to ask this computer's Driver Station for the robot's address, too
    """

    def __init__(self, name: str, servers: Sequence[tuple[str, int]], asks_driver_station: bool = False) -> None:
        self._tables = tables = ntcore.NetworkTableInstance.create()
        self._poller = ntcore.NetworkTableListenerPoller(tables)
        every = ntcore.PubSubOptions(sendAll=True, keepDuplicates=True, periodic=_INTERVAL)
        self._subscriber = ntcore.MultiSubscriber(tables, [""], every)
        self._poller.addListener(self._subscriber, _TOPICS | _VALUES)
        self._poller.addConnectionListener(True)
        self._types: dict[str, str] = {}
        self._publishers: dict[str, ntcore.GenericPublisher] = {}
        tables.setServer(list(servers))
        tables.startClient4(name)
        if asks_driver_station:
            tables.startDSClient()

    def read(self) -> Iterator[News]:
        """Yield what was received since the last call, in order."""
        for event in self._poller.readQueue():
            data: Any = event.data
            if isinstance(data, ntcore.ValueEventData):
                name, value = data.topic.getName(), data.value
                time_us = 0 if int(event.flags) & _LOCAL else value.server_time()
                yield Received(name, self._types.get(name, ""), value.value(), time_us)
            elif isinstance(data, ntcore.TopicInfo):
                if int(event.flags) & _GONE:
                    yield Gone(data.name)
                else:
                    self._types[data.name] = data.type_str
            elif isinstance(data, ntcore.ConnectionInfo):
                yield Connected(data.remote_ip, data.remote_port) if int(event.flags) & _CONNECTED else Lost()

    @property
    def now_us(self) -> int | None:
        """The time of the server's clock, in microseconds; None without a connection."""
        offset = self._tables.getServerTimeOffset()
        return None if offset is None else int(ntcore.Value.makeBoolean(True).time()) + int(offset)

    def write(self, name: str, value: Any, type_name: str) -> None:
        """Set the value of a topic, or of the one that is there for it.

        :param type_name: its type, one of `network.TYPES`
        :raises TypeError, ValueError, RuntimeError: when it cannot have this value
        :raises UsageError: when robot code does not let dashboards set it
        """
        properties = self._tables.getTopic(name).getProperties()
        name = written_entry(name, properties if isinstance(properties, dict) else {})
        converted = value_of_type(value, type_name)
        if name not in self._publishers:
            self._publishers[name] = self._tables.getTopic(name).genericPublish(type_name)
        self._publishers[name].set(converted)

    def stop_writing(self) -> None:
        """Publish no topic any longer. The values stay."""
        self._publishers.clear()

    def close(self) -> None:
        """End."""
        self._publishers.clear()
        # Before the tables are: later, the same numbers would be those of the next client's.
        self._subscriber.close()
        self._poller.close()
        ntcore.NetworkTableInstance.destroy(self._tables)
