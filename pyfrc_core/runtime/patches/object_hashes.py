"""Hashes of WPILib's and vendors' objects that are the same in every run.

Python hashes an object by its address in memory, unless its class says otherwise. Addresses differ from run to run, and
the hashes determine the order of a set. commands2 keeps the commands of a race group in a set: of ``a.until(b)``, some
runs executed the command first and others the condition, and a command that ended one packet earlier was the result.

All classes of WPILib's bindings and of vendors' C++ libraries derive from one class of pybind11's, which gets a hash
that counts. So do those of commands2; since 2027 they derive from another class, which gets it, too. The numbers begin
again with each run, so the same program gives its objects the same ones. Objects of other classes (a plain
``class Module:``) keep the hashes that depend on their addresses.
"""

from __future__ import annotations

import itertools
import weakref
from typing import Any

from ...patch_table import Patch
from ...wpi import robots


class _ObjectNumber(weakref.ref[Any]):
    """The number of an object, for as long as the object exists. The bindings' objects have no attributes."""

    __slots__ = ("address", "number")

    address: int
    number: int


_numbered: dict[int, _ObjectNumber] = {}  # by the addresses of the objects
_counter = itertools.count()


def patches() -> list[Patch]:
    """Return the patches of the classes that WPILib's and commands2's derive from."""
    return [Patch(each, "__hash__", hash_by_number) for each in robots.DERIVED_FROM]


def hash_by_number(self: Any) -> int:
    """Return the number of an object: how many others were hashed before it in this run. To be used as ``__hash__``."""
    address = id(self)
    found = _numbered.get(address)
    if found is None:
        found = _ObjectNumber(self, _forget)
        found.address, found.number = address, next(_counter)
        _numbered[address] = found
    return found.number


def restart_numbers() -> None:
    """Begin again with 0 for new objects. Objects that have a number keep it: it may be in use in a set."""
    global _counter
    _counter = itertools.count()


def _forget(gone: _ObjectNumber, numbered: dict[int, _ObjectNumber] = _numbered) -> None:
    numbered.pop(gone.address, None)
