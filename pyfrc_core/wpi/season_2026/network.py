"""NetworkTables: the robot's own tables, which stay in its process, and copies that are served to dashboards.

Values are plain: bool, int, float, str, lists of these, and bytes for everything else, such as structs. Types have the
names that NetworkTables gives them, such as ``double[]``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import ntcore

from ...compat.private_name import PrivateName

NETWORK_LOG = PrivateName(
    "ntcore._logutil:NtLogForwarder.onInstanceStart",
    "NetworkTables calls it when it starts: fuzz.match.preparation replaces it, since no one reads what matches log",
)

_MAKE: dict[str, Callable[[Any], ntcore.Value]] = {
    "boolean": ntcore.Value.makeBoolean,
    "int": ntcore.Value.makeInteger,
    "float": ntcore.Value.makeFloat,
    "double": ntcore.Value.makeDouble,
    "string": ntcore.Value.makeString,
    "boolean[]": ntcore.Value.makeBooleanArray,
    "int[]": ntcore.Value.makeIntegerArray,
    "float[]": ntcore.Value.makeFloatArray,
    "double[]": ntcore.Value.makeDoubleArray,
    "string[]": ntcore.Value.makeStringArray,
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

_VALUES, _VALUES_OF_OTHERS = int(ntcore.EventFlags.kValueAll), int(ntcore.EventFlags.kValueRemote)
_NAMES, _GONE = int(ntcore.EventFlags.kPublish), int(ntcore.EventFlags.kUnpublish)
_CURRENT = int(ntcore.EventFlags.kImmediate)


def _tables() -> ntcore.NetworkTableInstance:
    return ntcore.NetworkTableInstance.getDefault()


def start() -> None:
    """Start the robot's tables. Values that it publishes stay in this process: no server, no port, no file."""
    _tables().startLocal()


def stop() -> None:
    """Stop the robot's tables."""
    _tables().stopLocal()


def serve_this_computer(port: int) -> None:
    """Serve the robot's tables to this computer, with their persistent values in a file, as a robot program does."""
    _tables().startServer("networktables.json", "127.0.0.1", 0, port)


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
            self.name, self.value = news.topic.getName(), news.value.value()
        else:
            self.name, self.value = news.name, None

    @property
    def type_name(self) -> str:
        """The name of the entry's type."""
        news = self._news
        return news.topic.getTypeString() if isinstance(news, ntcore.ValueEventData) else str(news.type_str)


class Listener:
    """Collects what changes, from its creation on."""

    def __init__(self, tables: ntcore.NetworkTableInstance, flags: int) -> None:
        self._poller, self._flags = ntcore.NetworkTableListenerPoller(tables), flags
        self.resume()

    def read(self) -> Iterator[EntryUpdate]:
        """Yield what has changed since the last call."""
        return map(EntryUpdate, (event.data for event in self._poller.readQueue()))

    def close(self) -> None:
        """Collect nothing any longer."""
        self._poller.close()

    def pause(self) -> None:
        """Collect nothing until `resume` is called, and forget what was not read."""
        self._poller.removeListener(self._handle)
        self._poller.readQueue()

    def resume(self) -> None:
        """Go on, as from its creation."""
        self._handle = self._poller.addListener([""], self._flags)


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
    return [topic.getName() for topic in _tables().getTopics()]


def entries() -> list[tuple[str, str]]:
    """Return the full name of each entry that is published, with the name of its type."""
    return [(topic.getName(), topic.getTypeString()) for topic in _tables().getTopics()]


def count_entries() -> int:
    """Return how many entries are published."""
    return len(_tables().getTopics())


def exists(name: str) -> bool:
    """Return whether an entry is published."""
    return _tables().getTopic(name).exists()


def type_of(name: str) -> str:
    """Return the name of the type of an entry, such as ``double[]``; "" if it is not published."""
    return _tables().getTopic(name).getTypeString()


def written_entry(name: str, properties: Mapping[str, Any]) -> str:
    """Return the entry that a dashboard writes to change this one, which has these properties: itself."""
    return name


def value_of(name: str) -> Any:
    """Return the value of an entry; None if it has none."""
    entry = _tables().getEntry(name)
    return entry.getValue().value() if entry.exists() else None


def text_of(name: str) -> str:
    """Return the text of an entry; "" if it has none."""
    text: str = _tables().getEntry(name).getString("")
    return text


def texts_of(name: str) -> list[str]:
    """Return the texts of an entry; none if it has none."""
    texts: list[str] = _tables().getEntry(name).getStringArray([])
    return texts


def number_of(name: str) -> float:
    """Return the number of an entry; 0 if it has none."""
    number: float = _tables().getEntry(name).getDouble(0.0)
    return number


def persistent_values() -> Iterator[tuple[str, str, Any]]:
    """Yield name, type and value of the entries that a robot keeps in a file, if their types are in `TYPES`."""
    for topic in _tables().getTopics():
        name, type_name = topic.getName(), topic.getTypeString()
        if type_name in _MAKE and (name.startswith(_PREFERENCES) or topic.isPersistent()):
            yield name, type_name, _tables().getEntry(name).getValue().value()


#: Entries that WPILib publishes for itself, in C++, for as long as the process lives.
OF_WPILIB = ("/.schema/", "/FMSInfo/", "/LiveWindow/.status/", "/Preferences/.type", "/Shuffleboard/.")


def forget_entries() -> None:
    """Publish no entry any longer that is published by no object of the robot's."""
    for topic in _tables().getTopics():
        topic.setPersistent(False)
        topic.setRetained(False)
        _tables().getEntry(topic.getName()).unpublish()


# -- what is written to it ---------------------------------------------------------------------------------------------


class Entry:
    """An entry of the robot's tables that is written to.

    :ivar name: its name
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._entry = _tables().getEntry(name)

    @property
    def type_name(self) -> str:
        """The name of the entry's type; empty if it has none yet."""
        return self._entry.getTopic().getTypeString()

    def write(self, value: Any, type_name: str = "", at_us: int | None = None) -> bool:
        """Write a plain value, and return whether the entry can have it.

        :param type_name: one of `TYPES`; empty: that of the value in Python
        :param at_us: the value's time, in microseconds of robot time; None: now
        :raises TypeError, ValueError, RuntimeError: when no value can be made of it
        """
        if at_us is None:
            return self._entry.setValue(value_of_type(value, type_name) if type_name else value)
        made = value_of_type(value, type_name) if type_name else ntcore.Value.makeValue(value)
        made.setTime(at_us)
        return self._entry.setValue(made)

    def keep(self) -> None:
        """Make the entry persistent."""
        self._entry.setPersistent()

    def unpublish(self) -> None:
        """Publish it no longer."""
        self._entry.unpublish()


class DataEntry:
    """An entry of the robot's tables to which bytes are written.

    :param type_name: the name of its type, such as ``struct:Pose2d``
    """

    def __init__(self, name: str, type_name: str) -> None:
        self._publisher = _tables().getRawTopic(name).publish(type_name)
        #: Publish it no longer.
        self.unpublish: Callable[[], None] = self._publisher.close

    def write(self, value: bytes, at_us: int | None = None) -> None:
        """Write the bytes; the arguments are those of `Entry.write`."""
        self._publisher.set(value, 0 if at_us is None else at_us)


class NetworkServer:
    """Other tables than the robot's, served to dashboards.

    :param listen: the address of this computer at which they can connect; empty: all of them. None: no one can
    """

    def __init__(self, listen: str | None, port: int) -> None:
        self._tables = ntcore.NetworkTableInstance.create()
        self._published: dict[str, tuple[str, ntcore.GenericPublisher]] = {}
        if listen is not None:
            self._tables.startServer("", listen, 0, port)
        #: What dashboards write.
        self.written = Listener(self._tables, _VALUES_OF_OTHERS)

    def publish(self, update: EntryUpdate) -> None:
        """Publish a value of the robot's tables, with its type and its properties."""
        name, kind = update.name, update.type_name
        known = self._published.get(name)
        if known is None or known[0] != kind:
            served = self._tables.getTopic(name)
            self._published[name] = known = (kind, served.genericPublish(kind))
            served.setProperties(update._news.topic.getProperties())
        known[1].set(update._news.value)

    def close(self) -> None:
        """Release the port."""
        # Before the tables are: later, the same numbers would be those of the next server's.
        self._published.clear()
        self.written.close()
        ntcore.NetworkTableInstance.destroy(self._tables)
