"""What `pyfrc migrate` cannot do, or did in a way that should be checked: what, what to do, and in which lines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field


@dataclass(frozen=True, order=True)
class Place:
    """A line.

    :param file: relative to the project, with `/`
    :param line: of the file as it was, from 1; 0 for the whole file
    """

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file


@dataclass(frozen=True)
class Remark:
    """One remark, with all places that it is about.

    :param done: the code was rewritten or has another meaning, and should be checked; else it must be changed by hand
    """

    what: str
    remedy: str
    places: tuple[Place, ...]
    done: bool = False

    def __str__(self) -> str:
        return f"{self.places[0]}: {self.text()}"

    def text(self) -> str:
        """Return what is to do, without the places."""
        return f"{self.what}{' ' if self.remedy else ''}{self.remedy}"


@dataclass
class Report:
    """The remarks of a project, each once."""

    _places: dict[tuple[str, str, bool], set[Place]] = field(default_factory=dict)
    #: The lines that were rewritten.
    changed: set[Place] = field(default_factory=set)

    def add(self, file: str, line: int, what: str, remedy: str = "", *, done: bool = False) -> None:
        """Add a remark, or another place of it."""
        self._places.setdefault((what, remedy, done), set()).add(Place(file, line))

    def forget(self, file: str) -> None:
        """Leave out what was said of a file."""
        for places in self._places.values():
            places -= {each for each in places if each.file == file}

    def by_hand(self) -> list[Remark]:
        """Return what must be changed by hand, first what has most places."""
        return self._remarks(done=False)

    def to_check(self) -> list[Remark]:
        """Return what should be checked: it was rewritten, or has another meaning."""
        return self._remarks(done=True)

    def _remarks(self, *, done: bool) -> list[Remark]:
        found = [
            Remark(what, remedy, tuple(sorted(places)), is_done)
            for (what, remedy, is_done), places in self._places.items()
            if is_done == done and places
        ]
        return sorted(found, key=lambda each: (-len(each.places), each.places, each.what))

    def counts(self) -> dict[str, int]:
        """Return how many lines were changed, are left to do by hand, and were changed and need no look."""
        by_hand, to_check = lines_of(self.by_hand()), lines_of(self.to_check())
        return {
            "changed": len(self.changed),
            "by_hand": len(by_hand),
            "sure": len(self.changed - by_hand - to_check),
        }


def lines_of(remarks: Iterable[Remark]) -> set[Place]:
    """Return the places of several remarks, each once."""
    return {place for each in remarks for place in each.places}
