"""The parts of `hal_data` whose paths come and go with their values: the match, joysticks, free keys."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from ..compat.hal_callbacks import Report, WriteFlags
from .changing_values import are_reported
from .containers import plain
from .paths import join

#: What a part finds when it is refreshed: nothing new, other values, or other paths.
NOTHING, VALUES, PATHS = range(3)


class Part:
    """Some paths of the tree, and their values.

    Attributes:
        reports: what the HAL reports when one of them may have changed
        begin: the position of the first one among all paths
    """

    reports: tuple[Report, ...] = ()

    def __init__(self) -> None:
        self.paths: list[str] = []
        self.values: list[Any] = []
        self.begin = 0

    def refresh(self) -> int:
        """Update `paths` and `values`; return what has changed."""
        raise NotImplementedError


class _Source(Protocol):
    reports: tuple[Report, ...]

    def fingerprint(self) -> object:
        """Return a value that differs after any change."""


class RarelyChanged(Part):
    """Values that rarely change, and are read only when their fingerprint has changed."""

    def __init__(self, source: _Source, read: Callable[[], list[tuple[str, Any]]]) -> None:
        super().__init__()
        self.reports = source.reports
        self._fingerprint, self._read = source.fingerprint, read
        self._before: object = None

    def refresh(self) -> int:
        now = self._fingerprint()
        if now == self._before:
            return NOTHING
        self._before = now
        found, before = self._read(), self.paths
        self.paths, self.values = [path for path, _ in found], [value for _, value in found]
        return VALUES if self.paths == before else PATHS


class FreeValues(Part):
    """The values of free keys, which may be anything."""

    def __init__(self, name: str, source: Mapping[str, object]) -> None:
        super().__init__()
        self._name, self._source = name, source
        self._keys: list[str] = []

    def refresh(self) -> int:
        if not self._source and not self._keys:
            return NOTHING
        keys, self.values = list(self._source), [plain(value) for value in self._source.values()]
        if keys == self._keys:
            return VALUES
        self._keys, self.paths = keys, [join(self._name, key) for key in keys]
        return PATHS


class Parts:
    """All parts, of which only those are refreshed that may have changed."""

    def __init__(self, *parts: Part) -> None:
        self.all = parts
        #: The parts with the same reports, for each flag.
        self._reported: list[list[Part]] = []
        self._polled: list[Part] = list(parts)
        self._flags = WriteFlags(())

    def register(self) -> None:
        """Have the HAL report changes from now on, and refresh all parts; again after a reset."""
        reported: dict[tuple[Report, ...], list[Part]] = {}
        self._polled = []
        for part in self.all:
            (reported.setdefault(part.reports, []) if are_reported(part.reports) else self._polled).append(part)
        self._flags.close()
        self._flags, self._reported = WriteFlags(list(reported)), list(reported.values())
        for part in self.all:
            part.refresh()

    def refresh(self) -> tuple[int, list[Part]]:
        """Refresh what may have changed; return the greatest change, and the parts that have changed."""
        greatest, changed = NOTHING, []
        reported = [part for number in self._flags.take() for part in self._reported[number]]
        for part in reported + self._polled:
            if change := part.refresh():
                greatest = max(greatest, change)
                changed.append(part)
        return greatest, changed
