"""A run that is over, such as a log: all its values, and what happened in it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal, NamedTuple

from .messages import VALUE
from .value_history import ValueHistory

#: The two kinds of values: those of `hal_data`, and those of NetworkTables with the mode and the robot's place.
Stream = Literal["hal", "network"]


class Happened(NamedTuple):
    """Something that happened.

    :param time: in seconds of the run
    :param level: of the console's line: ``info``, ``warning`` or ``error``; empty: the text shows it
    :param is_mark: whether the timeline shows it, too, if it is a warning or an error
    """

    time: float
    level: Literal["", "info", "warning", "error"]
    text: str
    is_mark: bool = False


@dataclass(frozen=True)
class Comparison:
    """How values of two runs are compared. By default they are equal or not, as those of former runs.

    :param is_log: whether the other run is a log: only values that both have are compared, and not those from outside
    :param share: values are equal if they differ by at most this share of their range
    :param late: how late a value may come, in seconds
    :param given: the values from outside, besides those of the driver station
    :param replayed: the subsystems whose inputs the log has, which only the library that wrote it can give to the code
    :param ignored: names of values that are not compared, as reports print them; ``*`` stands for any text
    :param limits: what cannot be compared, as sentences; each after since when differences may come from it, in seconds
    """

    is_log: bool = False
    share: float = 0.0
    late: float = 0.0
    given: frozenset[str] = frozenset()
    replayed: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    limits: tuple[tuple[float, str], ...] = ()

    def ignores(self, path: str) -> bool:
        """Return whether a value, or the topic or device that it is part of, is not compared."""
        return bool(self.ignored) and _pattern(self.ignored).fullmatch(name_of(path)) is not None


def name_of(path: str) -> str:
    """Return the name of a value for people: of one in NetworkTables, without the table of what robot code shows."""
    return path.removeprefix(VALUE).removeprefix("/SmartDashboard/").removeprefix("/")


@cache
def _pattern(names: tuple[str, ...]) -> re.Pattern[str]:
    """Return the pattern of the values with some names, and of their parts."""
    shown = (re.escape(name_of(f"/{name.removeprefix(VALUE).removeprefix('/')}")) for name in names)
    return re.compile(f"(?:{'|'.join(shown)})(?:[/.].*)?".replace(r"\*", ".*"), re.DOTALL)


#: How former runs are compared.
EXACT = Comparison()


@dataclass(frozen=True)
class PastRun:
    """Its times are in seconds, from 0.

    :param name: for people, such as the name of a file
    :param end: the end of its time
    :param happened: what it printed, and what went wrong, in the order of time
    :param offset: what is added to its times where it is a branch of another run
    :param compared: how it is compared with that one; None: it is not
    """

    name: str
    end: float
    histories: Mapping[Stream, ValueHistory]
    happened: tuple[Happened, ...] = ()
    offset: float = 0.0
    compared: Comparison | None = None
