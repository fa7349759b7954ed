"""What `pyfrc migrate` cannot do, or did in a way that should be checked: file, line, what, and what to do."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, order=True)
class Remark:
    """One remark.

    :param file: relative to the project, with `/`
    :param line: of the file as it was, from 1; 0 for the whole file
    :param done: the code was rewritten or has another meaning, and should be checked; else it must be changed by hand
    """

    file: str
    line: int
    what: str
    remedy: str
    done: bool = False

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line else self.file
        return f"{place}: {self.what}{' ' if self.remedy else ''}{self.remedy}"


@dataclass
class Report:
    """The remarks of a project, each once."""

    remarks: set[Remark] = field(default_factory=set)

    def add(self, file: str, line: int, what: str, remedy: str = "", *, done: bool = False) -> None:
        """Add a remark."""
        self.remarks.add(Remark(file, line, what, remedy, done))

    def by_hand(self) -> list[Remark]:
        """Return what must be changed by hand, by file and line."""
        return sorted(each for each in self.remarks if not each.done)

    def to_check(self) -> list[Remark]:
        """Return what should be checked: it was rewritten, or has another meaning."""
        return sorted(each for each in self.remarks if each.done)
