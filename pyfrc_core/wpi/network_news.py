"""What a client of NetworkTables receives, the same in each season."""

from __future__ import annotations

from typing import Any, NamedTuple


class Received(NamedTuple):
    """A value of a topic.

    :param value: plain, or bytes
    :param time_us: when it was set, in microseconds of the server's clock; 0: just now, by this client
    """

    name: str
    type_name: str
    value: Any
    time_us: int


class Gone(NamedTuple):
    """A topic is no longer published. When the connection is lost, that is reported of each of the server's topics."""

    name: str


class Connected(NamedTuple):
    """The client has connected to a server; its topics and their values follow."""

    host: str
    port: int


class Lost(NamedTuple):
    """The connection was lost. The client tries to connect again by itself."""


News = Received | Gone | Connected | Lost

#: The types of topics with plain values, and the type of such a value, or of each in a list, in Python.
PLAIN_TYPES: dict[str, type] = {
    f"{name}{end}": kind
    for name, kind in {"boolean": bool, "int": int, "float": float, "double": float, "string": str}.items()
    for end in ("", "[]")
}
