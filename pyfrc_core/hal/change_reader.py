"""What has changed in `hal_data` between two looks of one reader. Several readers do not affect each other.

Each look reads every value, through WPILib's own functions, and compares it with the one before.
"""

from __future__ import annotations

from itertools import compress
from math import copysign
from operator import ne
from typing import Any, NamedTuple, Protocol


class _Missing:
    def __repr__(self) -> str:
        return "MISSING"


#: Stands for the value of a path that did not exist.
MISSING: Any = _Missing()


#: A value that has changed, or come: its path, the old value or `MISSING`, and the new one. Not a named tuple, because
#: a trace has dozens of them in each packet.
Change = tuple[str, Any, Any]

_SCALARS = frozenset((float, int, bool, str, bytes))


class Changes(NamedTuple):
    """What a look has found, in the order of `HalData.leaves`.

    :param changed: the values that have changed or come, even if only from 0.0 to -0.0
    :param gone: the paths that no longer exist
    """

    changed: list[Change]
    gone: list[str]


class ValueReader(Protocol):
    """What is read: see `TreeReader`."""

    def read(self) -> tuple[list[str], list[Any]]:
        """Return all paths, in a list that stays the same while they do, and a new list of their values."""


class ChangeReader:
    """Finds what has changed since its last look."""

    def __init__(self, source: ValueReader) -> None:
        self._source = source
        self._paths: list[str] = []
        self._values: list[Any] = []

    def look(self) -> Changes:
        """Return what has changed since the last look; at first, all values."""
        paths, before = self._paths, self._values
        self.skip()
        now = self._values
        if self._paths is not paths:
            return self._compare_paths(paths, before)
        changed = [
            (path, old, new)
            for path, old, new in zip(paths, before, now, strict=True)
            # Most are the same object, or equal: only then 0.0 and -0.0, True and 1, or parts of a list may differ.
            if old is not new and not (old == new and new and type(old) is type(new) in _SCALARS) and not same(old, new)
        ]
        return Changes(changed, [])

    def look_at_values(self) -> tuple[dict[str, Any], list[str]]:
        """Return the values that have changed or come, by path, and the paths that no longer exist; faster than `look`.

        Values that compare equal to the old ones, such as 0.0 and -0.0, are left out.
        """
        paths, before = self._paths, self._values
        self.skip()
        now = self._values
        if self._paths is not paths:
            found, gone = self._compare_paths(paths, before)
            return {path: new for path, old, new in found if old != new}, gone
        differing = compress(zip(paths, before, now, strict=True), map(ne, before, now))
        # NaN differs from itself, also in a list.
        changed = {
            path: new for path, old, new in differing if (new == new and type(new) is not list) or not same(old, new)
        }
        return changed, []

    def skip(self) -> None:
        """Look without finding what has changed."""
        self._paths, self._values = self._source.read()

    def _compare_paths(self, paths: list[str], values: list[Any]) -> Changes:
        """Return what has changed since these paths had these values."""
        before = dict(zip(paths, values, strict=True))
        changed: list[Change] = []
        for path, new in zip(self._paths, self._values, strict=True):
            old = before.pop(path, MISSING)
            if not same(old, new):
                changed.append((path, old, new))
        return Changes(changed, list(before))


def same(old: Any, new: Any) -> bool:
    """Return whether two values are written alike: -0.0 is not 0.0, True is not 1, and NaN is NaN."""
    if old is new:
        return True
    kind = type(old)
    if kind is type(new) and kind in _SCALARS:  # texts take long to make
        if kind is not float:
            return bool(old == new)
        return copysign(1, old) == copysign(1, new) if old == new else old != old and new != new
    return repr(old) == repr(new)
