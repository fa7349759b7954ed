"""What has changed in `hal_data` between two looks of one reader. Several readers do not affect each other."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from .changing_values import same


class _Missing:
    def __repr__(self) -> str:
        return "MISSING"


#: Stands for the value of a path that did not exist.
MISSING: Any = _Missing()


#: A value that has changed, or come: its path, the old value or `MISSING`, and the new one. Not a named tuple, because
#: a trace has dozens of them in each packet.
Change = tuple[str, Any, Any]


class Changes(NamedTuple):
    """What a look has found, in the order of `HalData.leaves`.

    :param changed: the values that have changed or come, even if only from 0.0 to -0.0
    :param gone: the paths that no longer exist
    """

    changed: list[Change]
    gone: list[str]


class Source(Protocol):
    """What is read: see `TreeReader`."""

    paths: list[str]
    values: list[Any]
    version: int

    def refresh(self) -> None:
        """Update the attributes."""

    def changed_since(self, version: int) -> list[int]:
        """Return the positions of values that may have changed since a version with the same `paths`, in order."""


class ChangeReader:
    """Finds what has changed since its last look, in a time that depends on the number of changes only."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._version = -1
        self._paths: list[str] = []
        self._values: list[Any] = []

    def look(self) -> Changes:
        """Return what has changed since the last look; at first, all values."""
        source, version = self._source, self._version
        source.refresh()
        self._version = source.version
        if source.version == version:
            return Changes([], [])
        if source.paths is not self._paths:
            return self._compare_all()
        changed: list[Change] = []
        paths, before, now = self._paths, self._values, source.values
        for position in source.changed_since(version):
            old, new = before[position], now[position]
            if (old != new and new == new) or not same(old, new):  # NaN differs from itself
                before[position] = new
                changed.append((paths[position], old, new))
        return Changes(changed, [])

    def look_at_values(self) -> tuple[dict[str, Any], list[str]]:
        """Return the values that have changed or come, by path, and the paths that no longer exist; faster than `look`.

        Values that compare equal to the old ones, such as 0.0 and -0.0, are left out.
        """
        source, version = self._source, self._version
        source.refresh()
        self._version = source.version
        changed: dict[str, Any] = {}
        if source.version == version:
            return changed, []
        if source.paths is not self._paths:
            found, gone = self._compare_all()
            return {path: new for path, old, new in found if old != new}, gone
        paths, before, now = self._paths, self._values, source.values
        for position in source.changed_since(version):
            old, new = before[position], now[position]
            before[position] = new
            if old != new and (old == old or new == new):  # NaN differs from itself
                changed[paths[position]] = new
        return changed, []

    def skip(self, refresh: bool = True) -> None:
        """Look without finding what has changed, which takes less time.

        :param refresh: False when nothing can have changed since any reader of the same tree has looked
        """
        source = self._source
        if refresh:
            source.refresh()
        version, self._version = self._version, source.version
        if source.paths is not self._paths:
            self._paths, self._values = source.paths, source.values.copy()
        elif source.version != version:
            for position in source.changed_since(version):
                self._values[position] = source.values[position]

    def _compare_all(self) -> Changes:
        before = dict(zip(self._paths, self._values, strict=True))
        self._paths, self._values = self._source.paths, self._source.values.copy()
        changed: list[Change] = []
        for path, new in zip(self._paths, self._values, strict=True):
            old = before.pop(path, MISSING)
            if not same(old, new):
                changed.append((path, old, new))
        return Changes(changed, list(before))
