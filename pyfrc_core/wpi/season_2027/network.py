"""NetworkTables: the robot's own tables, which stay in its process, and copies that are served to dashboards.

Values are plain: bool, int, float, str, lists of these, and bytes for everything else, such as structs. Types have the
names that NetworkTables gives them, such as ``double[]``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import ntcore

from ...compat.private_name import PrivateName
from ...errors import UsageError
from . import timing

NETWORK_LOG = PrivateName(
    "ntcore._logutil:NtLogForwarder.on_instance_start",
    "NetworkTables calls it when it starts: fuzz.match.preparation replaces it, since no one reads what matches log",
)

_MAKE: dict[str, Callable[[Any], ntcore.Value]] = {
    "boolean": ntcore.Value.make_boolean,
    "int": ntcore.Value.make_integer,
    "float": ntcore.Value.make_float,
    "double": ntcore.Value.make_double,
    "string": ntcore.Value.make_string,
    "boolean[]": ntcore.Value.make_boolean_array,
    "int[]": ntcore.Value.make_integer_array,
    "float[]": ntcore.Value.make_float_array,
    "double[]": ntcore.Value.make_double_array,
    "string[]": ntcore.Value.make_string_array,
}

#: The types of plain values.
TYPES = tuple(_MAKE)


def value_of_type(value: Any, type_name: str) -> ntcore.Value:
    """Return a plain value as NetworkTables has it.

    :param type_name: one of `TYPES`
    :raises TypeError, ValueError, RuntimeError, KeyError: when no value can be made of it
    """
    return _MAKE[type_name](value)


#: Where `wpilib.Preferences` has its entries; not all are marked as persistent at once.
_PREFERENCES = "/Preferences/"

_VALUES, _VALUES_OF_OTHERS = int(ntcore.EventFlags.VALUE_ALL), int(ntcore.EventFlags.VALUE_REMOTE)
_NAMES, _GONE = int(ntcore.EventFlags.PUBLISH), int(ntcore.EventFlags.UNPUBLISH)
_CURRENT = int(ntcore.EventFlags.IMMEDIATE)


def _tables() -> ntcore.NetworkTableInstance:
    return ntcore.NetworkTableInstance.get_default()


def start() -> None:
    """Start the robot's tables. Values that it publishes stay in this process: no server, no port, no file."""
    _tables().start_local()


def stop() -> None:
    """Stop the robot's tables."""
    _tables().stop_local()


def serve_this_computer(port: int) -> None:
    """Serve the robot's tables to this computer, with their persistent values in a file, as a robot program does."""
    _tables().start_server("networktables.json", "127.0.0.1", "", port)


# -- what is published -------------------------------------------------------------------------------------------------


class EntryUpdate:
    """News of an entry.

    :ivar name: its name
    :ivar value: its value; None if it was published, or is no longer
    """

    __slots__ = ("_news", "name", "value")

    def __init__(self, news: Any) -> None:
        self._news = news
        if isinstance(news, ntcore.ValueEventData):
            self.name, self.value = news.topic.get_name(), news.value.value()
        else:
            self.name, self.value = news.name, None

    @property
    def type_name(self) -> str:
        """The name of the entry's type."""
        news = self._news
        return news.topic.get_type_string() if isinstance(news, ntcore.ValueEventData) else str(news.type_str)


class Listener:
    """Collects what changes, from its creation on."""

    def __init__(self, tables: ntcore.NetworkTableInstance, flags: int) -> None:
        self._poller, self._flags = ntcore.NetworkTableListenerPoller(tables), flags
        self.resume()

    def read(self) -> Iterator[EntryUpdate]:
        """Yield what has changed since the last call."""
        return map(EntryUpdate, (event.data for event in self._poller.read_queue()))

    def close(self) -> None:
        """Collect nothing any longer."""
        self._poller.close()

    def pause(self) -> None:
        """Collect nothing until `resume` is called, and forget what was not read."""
        self._poller.remove_listener(self._handle)
        self._poller.read_queue()

    def resume(self) -> None:
        """Go on, as from its creation."""
        self._handle = self._poller.add_listener([""], self._flags)


def listen_for_values(*, current: bool = False, gone: bool = False) -> Listener:
    """Collect the values of the robot's tables.

    :param current: begin with the values that there are
    :param gone: also collect which entries are no longer published
    """
    return Listener(_tables(), _VALUES | (_CURRENT if current else 0) | (_GONE if gone else 0))


def listen_for_names() -> Listener:
    """Collect which entries of the robot's tables are published, those that exist first."""
    return Listener(_tables(), _NAMES | _CURRENT)


def entry_names() -> list[str]:
    """Return the full names of all entries that are published."""
    return [topic.get_name() for topic in _tables().get_topics()]


def entries() -> list[tuple[str, str]]:
    """Return the full name of each entry that is published, with the name of its type."""
    return [(topic.get_name(), topic.get_type_string()) for topic in _tables().get_topics()]


def count_entries() -> int:
    """Return how many entries are published."""
    return len(_tables().get_topics())


def exists(name: str) -> bool:
    """Return whether an entry is published."""
    return _tables().get_topic(name).exists()


def type_of(name: str) -> str:
    """Return the name of the type of an entry, such as ``double[]``; "" if it is not published."""
    return _tables().get_topic(name).get_type_string()


def properties_of(name: str) -> dict[str, Any]:
    """Return the properties of an entry; none if it is not published."""
    properties = _tables().get_topic(name).get_properties()
    return properties if isinstance(properties, dict) else {}


def written_entry(name: str, properties: Mapping[str, Any]) -> str:
    """Return the entry that a dashboard writes to change this one; a robust tunable has another one for it.

    :param properties: those of this entry
    :raises UsageError: when robot code does not let dashboards change it
    """
    if name.startswith("/Telemetry/"):
        raise UsageError("robot code only shows this: what can be changed is in Tunables")
    if not name.startswith("/Tunables/"):
        return name
    if properties.get("mutable") is False:
        raise UsageError("robot code has published this with mutable=False")
    return f"{name.removesuffix('/value')}/tune" if properties.get("robust") else name


def value_of(name: str) -> Any:
    """Return the value of an entry; None if it has none."""
    entry = _tables().get_entry(name)
    return entry.get_value().value() if entry.exists() else None


def text_of(name: str) -> str:
    """Return the text of an entry; "" if it has none."""
    text: str = _tables().get_entry(name).get_string("")
    return text


def texts_of(name: str) -> list[str]:
    """Return the texts of an entry; none if it has none."""
    texts: list[str] = _tables().get_entry(name).get_string_array([])
    return texts


def number_of(name: str) -> float:
    """Return the number of an entry; 0 if it has none."""
    number: float = _tables().get_entry(name).get_double(0.0)
    return number


def persistent_values() -> Iterator[tuple[str, str, Any]]:
    """Yield name, type and value of the entries that a robot keeps in a file, if their types are in `TYPES`."""
    for topic in _tables().get_topics():
        name, type_name = topic.get_name(), topic.get_type_string()
        if type_name in _MAKE and (name.startswith(_PREFERENCES) or topic.is_persistent()):
            yield name, type_name, _tables().get_entry(name).get_value().value()


#: Entries that WPILib publishes for itself, in C++, for as long as the process lives.
OF_WPILIB = ("/.schema/", "/FMSInfo/", "/DriverStation/", "/Preferences/.type")


def forget_entries() -> None:
    """Publish no entry any longer that is published by no object of the robot's."""
    for topic in _tables().get_topics():
        topic.set_persistent(False)
        topic.set_retained(False)
        _tables().get_entry(topic.get_name()).unpublish()


# -- what is written to it ---------------------------------------------------------------------------------------------


class Entry:
    """An entry of the robot's tables that is written to.

    :ivar name: its name
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._entry = _tables().get_entry(name)

    @property
    def type_name(self) -> str:
        """The name of the entry's type; empty if it has none yet."""
        return self._entry.get_topic().get_type_string()

    def write(self, value: Any, type_name: str = "", at_us: int | None = None) -> bool:
        """Write a plain value, and return whether the entry can have it.

        :param type_name: one of `TYPES`; empty: that of the value in Python
        :param at_us: the value's time, in microseconds of robot time; None: now
        :raises TypeError, ValueError, RuntimeError: when no value can be made of it
        """
        if at_us is None:
            return self._entry.set_value(value_of_type(value, type_name) if type_name else value)
        made = value_of_type(value, type_name) if type_name else ntcore.Value.make_value(value)
        made.set_time(timing.hal_time(at_us))
        return self._entry.set_value(made)

    def keep(self) -> None:
        """Make the entry persistent."""
        self._entry.set_persistent()

    def unpublish(self) -> None:
        """Publish it no longer."""
        self._entry.unpublish()


class DataEntry:
    """An entry of the robot's tables to which bytes are written.

    :param type_name: the name of its type, such as ``struct:Pose2d``
    """

    def __init__(self, name: str, type_name: str) -> None:
        self._publisher = _tables().get_raw_topic(name).publish(type_name)
        #: Publish it no longer.
        self.unpublish: Callable[[], None] = self._publisher.close

    def write(self, value: bytes, at_us: int | None = None) -> None:
        """Write the bytes; the arguments are those of `Entry.write`."""
        self._publisher.set(value, 0 if at_us is None else timing.hal_time(at_us))


class NetworkServer:
    """Other tables than the robot's, served to dashboards.

    :param listen: the address of this computer at which they can connect; empty: all of them. None: no one can
    """

    def __init__(self, listen: str | None, port: int) -> None:
        self._tables = ntcore.NetworkTableInstance.create()
        self._published: dict[str, tuple[str, ntcore.GenericPublisher]] = {}
        if listen is not None:
            self._tables.start_server("", listen, "", port)
        #: What dashboards write.
        self.written = Listener(self._tables, _VALUES_OF_OTHERS)

    def publish(self, update: EntryUpdate) -> None:
        """Publish a value of the robot's tables, with its type and its properties."""
        name, kind = update.name, update.type_name
        known = self._published.get(name)
        if known is None or known[0] != kind:
            served = self._tables.get_topic(name)
            self._published[name] = known = (kind, served.generic_publish(kind))
            served.set_properties(update._news.topic.get_properties())
        known[1].set(update._news.value)

    def close(self) -> None:
        """Release the port."""
        # Before the tables are: later, the same numbers would be those of the next server's.
        self._published.clear()
        self.written.close()
        ntcore.NetworkTableInstance.destroy(self._tables)
