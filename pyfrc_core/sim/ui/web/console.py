"""The robot's output as numbered lines with levels, and the line of the project's code that a line names."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from heapq import merge
from operator import attrgetter
from pathlib import Path
from typing import Literal, get_args

from ...engine.output_log import OWN
from ..models.wording import plain_output

Level = Literal["info", "warning", "error", "pyfrc"]

#: The number of lines that are kept of plain output and of each other level, and the most characters of a line.
MOST_LINES, MOST_IMPORTANT, _MOST_LENGTH = 2000, 500, 4000
#: How much of a flood is shown, in characters at once.
MOST_AT_ONCE = 60_000

_ERROR = re.compile(r"\s*(error|traceback|fatal|critical|\w+(\.\w+)*(Error|Exception)\b:)", re.IGNORECASE)
_WARNING = re.compile(r"\s*(warning|warn\b|\S+:\d+: \w*Warning:|watchdog|.*\boverrun)", re.IGNORECASE)
#: Lines inside a traceback.
_TRACE = re.compile(r'  File "|    |During handling of|The above exception')
_PLACE = re.compile(r'File "(?P<file>[^"]+\.py)", line (?P<line>\d+)|(?P<short>[\w./\\-]+\.py):(?P<number>\d+)')


@dataclass(frozen=True)
class ConsoleLine:
    """One line.

    :param n: its number; they count from 1
    :param t: the robot time at which it was printed; of what C++ code prints, at which it was seen; in seconds
    :param file: the file of the project that it names, relative to its root; empty: none
    """

    n: int
    t: float
    level: Level
    text: str
    file: str = ""
    line: int = 0

    def plain(self) -> dict[str, object]:
        """Return it for a page."""
        found: dict[str, object] = {"n": self.n, "t": round(self.t, 3), "level": self.level, "text": self.text}
        return found | ({"file": self.file, "line": self.line} if self.file else {})


class Console:
    """The last lines of output.

    :param root: the project's directory
    """

    def __init__(self, root: Path) -> None:
        self._roots = {root, root.resolve()}
        # Each level has its own: a flood of prints leaves the warnings, and a flood of warnings the errors.
        self._lines: dict[Level, deque[ConsoleLine]] = {
            level: deque(maxlen=MOST_LINES if level == "info" else MOST_IMPORTANT) for level in get_args(Level)
        }
        #: The number of all lines, also of those that are no longer kept.
        self.count = 0
        self._open = ""
        self._in_traceback = False

    def since(self, number: int) -> list[ConsoleLine]:
        """Return the kept lines after the one with this number."""
        lines = merge(*map(tuple, self._lines.values()), key=attrgetter("n"))
        return [line for line in lines if line.n > number]

    def add(self, text: str, time: float) -> list[ConsoleLine]:
        """Add output, and return its whole lines: a line that is not finished is kept until its end comes."""
        text = self._open + plain_output(text)
        skipped = 0
        if len(text) > MOST_AT_ONCE:  # only a program looks at so much
            cut = len(text) - MOST_AT_ONCE
            begin = text.find("\n", cut, -1) + 1 or cut
            skipped, text = text.count("\n", 0, begin), text[begin:]
        *whole, self._open = text.split("\n")
        if len(self._open) > _MOST_LENGTH:
            whole, self._open = [*whole, self._open], ""
        self.count += skipped
        return [self._append(line.removeprefix(OWN), time, self._level_of(line)) for line in whole]

    def say(self, text: str, time: float, level: Level = "pyfrc") -> list[ConsoleLine]:
        """Add lines of pyfrc's own."""
        return [self._append(line, time, level) for line in plain_output(text).splitlines()]

    def _append(self, text: str, time: float, level: Level) -> ConsoleLine:
        self.count += 1
        file, line = self._place(text)
        shown = text if len(text) <= _MOST_LENGTH else f"{text[:_MOST_LENGTH]}…"
        added = ConsoleLine(self.count, time, level, shown, file, line)
        self._lines[level].append(added)
        return added

    def _level_of(self, line: str) -> Level:
        if line.startswith(OWN):
            return "pyfrc"
        if self._in_traceback and _TRACE.match(line):
            return "error"
        self._in_traceback = line.startswith("Traceback")
        return "error" if _ERROR.match(line) else "warning" if _WARNING.match(line) else "info"

    def _place(self, text: str) -> tuple[str, int]:
        for match in _places(text):
            file = Path(match["file"] or match["short"])
            for root in self._roots:
                whole = root / file
                if whole.is_relative_to(root) and ".." not in file.parts and whole.is_file():
                    return whole.relative_to(root).as_posix(), int(match["line"] or match["number"])
        return "", 0


def _places(text: str) -> Iterator[re.Match[str]]:
    return _PLACE.finditer(text[:_MOST_LENGTH]) if ".py" in text else iter(())
