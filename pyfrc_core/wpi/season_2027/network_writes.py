"""The functions with which code writes entries of NetworkTables."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import ntcore

from ..entry_writes import MayWrite, guarded, publishers


def replacements(may_write: MayWrite) -> Iterator[tuple[Any, str, Any]]:
    """Return the functions that write entries, with their owner and name: each writes only what it may."""
    for publisher in publishers(ntcore):
        yield from guarded(publisher, _published, may_write)
    yield from guarded(ntcore.NetworkTableEntry, _entry, may_write)
    yield from guarded(ntcore.NetworkTable, _in_table, may_write)


def _published(publisher: Any, *_: object, **__: object) -> str:
    name: str = publisher.get_topic().get_name()
    return name


def _entry(entry: Any, *_: object, **__: object) -> str:
    name: str = entry.get_name()
    return name


def _in_table(table: Any, key: str, *_: object, **__: object) -> str:
    return f"{table.get_path()}/{key}"
