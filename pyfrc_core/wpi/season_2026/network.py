"""NetworkTables: the entries that are published, and their values."""

from __future__ import annotations

from typing import Any

from ntcore import NetworkTableInstance

from ...compat.private_name import PrivateName

NETWORK_LOG = PrivateName(
    "ntcore._logutil:NtLogForwarder.onInstanceStart",
    "NetworkTables calls it when it starts: fuzz.preparation replaces it, since no one reads what matches log",
)


def entry_names() -> list[str]:
    """Return the full names of all entries that are published."""
    return [topic.getName() for topic in _network().getTopics()]


def entries() -> list[tuple[str, str]]:
    """Return the full name of each entry that is published, with the name of its type."""
    return [(topic.getName(), topic.getTypeString()) for topic in _network().getTopics()]


def count_entries() -> int:
    """Return how many entries are published."""
    return len(_network().getTopics())


def exists(name: str) -> bool:
    """Return whether an entry is published."""
    return _network().getTopic(name).exists()


def type_of(name: str) -> str:
    """Return the name of the type of an entry, such as ``double[]``; "" if it is not published."""
    return _network().getTopic(name).getTypeString()


def value_of(name: str) -> Any:
    """Return the value of an entry; None if it has none."""
    entry = _network().getEntry(name)
    return entry.getValue().value() if entry.exists() else None


def text_of(name: str) -> str:
    """Return the text of an entry; "" if it has none."""
    text: str = _network().getEntry(name).getString("")
    return text


def texts_of(name: str) -> list[str]:
    """Return the texts of an entry; none if it has none."""
    texts: list[str] = _network().getEntry(name).getStringArray([])
    return texts


def number_of(name: str) -> float:
    """Return the number of an entry; 0 if it has none."""
    number: float = _network().getEntry(name).getDouble(0.0)
    return number


def _network() -> NetworkTableInstance:
    """Return the robot's network, which begins when it is first asked for."""
    return NetworkTableInstance.getDefault()
