"""Tables of replaced names of classes and modules: every monkeypatch of pyfrc is in one.

`unittest.mock.patch` does the same for one name. It would import much that a robot does not need.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

_ABSENT: Any = object()


class Patch(NamedTuple):
    """A name to replace.

    :param owner: the class or module
    :param value: what the name is to stand for there
    """

    owner: Any
    name: str
    value: Any


class PatchTable:
    """The names that one part of pyfrc has replaced, and their original values."""

    def __init__(self) -> None:
        self._originals: dict[tuple[Any, str], Any] = {}

    def __contains__(self, place: tuple[object, str]) -> bool:
        return place in self._originals

    def __bool__(self) -> bool:
        return bool(self._originals)

    def patch(self, owner: object, name: str, value: object) -> None:
        """Replace a name, whether the owner has it itself, inherits it, or lacks it.

        Replacing it again does not change the value that `undo` restores.
        """
        self._originals.setdefault((owner, name), vars(owner).get(name, _ABSENT))
        setattr(owner, name, value)

    def undo(self) -> None:
        """Restore all names, the last one first."""
        while self._originals:
            (owner, name), original = self._originals.popitem()
            if original is _ABSENT:
                delattr(owner, name)
            else:
                setattr(owner, name, original)


@contextmanager
def patched(patches: Iterable[Patch]) -> Iterator[None]:
    """Replace these names until the context ends."""
    table = PatchTable()
    for patch in list(patches):  # all are made from the original values
        table.patch(*patch)
    try:
        yield
    finally:
        table.undo()
