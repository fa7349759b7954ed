"""How code writes entries of NetworkTables: what the seasons' `network_writes` replace. It imports no WPILib."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

from .entry_reads import unbound

#: Returns whether an entry, given by its full name, may be written now.
MayWrite = Callable[[str], bool]

#: The methods that write a value, of publishers, entries and tables.
_WRITES = re.compile(r"(?:set|put)(?!_?persistent)\w*", re.IGNORECASE)


def publishers(ntcore: ModuleType) -> Iterator[type[Any]]:
    """Return the classes of publishers."""
    return (each for each in vars(ntcore).values() if isinstance(each, type) and each.__name__.endswith("Publisher"))


def guarded(owner: type[Any], name_of: Callable[..., str], may_write: MayWrite) -> Iterator[tuple[Any, str, Any]]:
    """Return the methods of a class that write entries, with their owner and name: each writes only what it may.

    :param name_of: returns an entry's full name, from the arguments of the call
    """
    for name in filter(_WRITES.fullmatch, vars(owner)):
        yield owner, name, _guarded(unbound(vars(owner)[name]), name_of, may_write)


def _guarded(real: Callable[..., Any], name_of: Callable[..., str], may_write: MayWrite) -> Callable[..., Any]:
    def write(*args: Any, **kwargs: Any) -> Any:
        __tracebackhide__ = True
        return real(*args, **kwargs) if may_write(name_of(*args, **kwargs)) else True

    return write
