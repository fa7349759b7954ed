"""Where two runs first differ.

Former runs have their times in common with the present one, so they differ where their values do. A log has the times
of another clock, its robot's loop is some milliseconds late now and then, and its sensors measure noise. There, a value
differs if the other run does not come close to it in the `Comparison.late` seconds before and after that moment.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

from ....compat.unrepeatable import in_real_time, real_time_device
from ....hal.rows import is_input
from ....runtime.scripts import kit_names
from ....runtime.scripts.network_targets import NETWORK_INPUTS
from ....runtime.scripts.sensors import camera_of, is_sensor
from ....runtime.scripts.trace_difference import rank
from ...engine.messages import MODE, POSE, TYPE, VALUE
from ...engine.past_run import EXACT, Comparison
from ...engine.value_history import MISSING, ValueHistory
from ..models.wording import differing_texts
from .plots import picked, resolve, same

#: The most paths that are named; and of those that differ from a log, with when, and both values.
_MOST_NAMED, _MOST_OTHERS = 20, 200
#: Times that are equal but for rounding. Numbers that differ by less than this share of the largest one, or of 1, are
#: equal where there is noise: a robot that stands turns by 1e-7 rad, in which there is no range to compare with.
_ROUNDING, _SMALLEST = 1e-6, 1e-6
#: Values that both runs have from outside, and those that robot code does not set; the last ones are entries that logs
#: add to what the robot publishes, and those that describe a table or a value.
_GIVEN = re.compile(
    rf"joysticks\[\d\]\.(axes|buttons|povs)|control\.|event\.|alliance_station|time\."
    rf"|{VALUE}/(FMSInfo|DS|DriverStation)/|{VALUE}/Robot/ProgramStartTime"
    rf"|{VALUE}/.*( \(physics\)/|/VisionSystemSim-|/Ids$)"  # the simulated field, and the numbers of commands
    rf"|{VALUE}/.*/state_descriptions$"  # docstrings, which magicbot publishes
    rf"|{VALUE}{kit_names.NOT_COMPUTED}"
    rf"|{re.escape(TYPE)}|{re.escape(MODE)}|{re.escape(POSE)}"
    rf"|{VALUE}((/(console|messages|systemTime|NTConnection|pose(/.*)?)|{NETWORK_INPUTS})$|/?(.*/)?\.[^/]+)"
)

#: A value that has just this range, or at most this share less, is taken for an angle: -180 and 180 are the same.
_TURNS, _LESS = (360.0, math.tau), 0.005

#: A value from a moment on.
Held = tuple[float, Any]


@dataclass
class FirstDifference:
    """The earliest difference that was found, and where.

    :param begin: look after this moment, in seconds of robot time; `end` is the last one
    :param by: how the values are compared
    :param offset: what is added to the times of the other run
    """

    begin: float
    end: float
    by: Comparison = EXACT
    offset: float = 0.0
    #: The first moments of all values that differ; in former runs only of the earliest.
    found: dict[str, float] = field(default_factory=dict)
    #: The values then: of the other run, and of this one.
    values: dict[str, tuple[Any, Any]] = field(default_factory=dict)
    #: Of the values that differ by less than what counts, by how much at most, as a share of their range, and when.
    slight: dict[str, tuple[float, float]] = field(default_factory=dict)
    #: How often those of `found` change, in the run in which they change more often.
    changes: dict[str, int] = field(default_factory=dict)
    #: How many values were compared; and of a log, those that both runs have, but never at the same time.
    compared: int = 0
    never: set[str] = field(default_factory=set)

    @property
    def time(self) -> float | None:
        """The earliest moment; None: there is no difference."""
        return min(self.found.values(), default=None)

    @property
    def by_rarity(self) -> bool:
        """Whether what changes rarely comes first: where runs do not repeat, what the sensors move differs at once."""
        return self.by.share > 0

    @property
    def paths(self) -> list[str]:
        """The values that differ first: among them, first what robot code sets."""
        found = self.sorted()
        return [path for path, time in found if time == found[0][1]][:_MOST_NAMED]

    def sorted(self) -> list[tuple[str, float]]:
        """Return all values that differ, the earliest first, or those that change most rarely."""
        return sorted(self.found.items(), key=self._order)

    def _order(self, moment: tuple[str, float]) -> tuple[object, ...]:
        path, time = moment
        return self.changes[path] if self.by_rarity else 0, time, not path.startswith(VALUE), rank(path)

    def sorted_slight(self) -> list[tuple[str, float, float]]:
        """Return all values that differ slightly, with by how much and when, those that differ most first."""
        slight = sorted(self.slight.items(), key=lambda each: (-each[1][0], rank(each[0])))
        return [(path, share, time) for path, (share, time) in slight]

    def plain(self, clean: Callable[[str], str]) -> dict[str, Any]:
        """Return it for a page, with all values that differ.

        :param clean: changes each text
        """
        others = []
        for path, time in self.sorted()[:_MOST_OTHERS]:
            both = ("no value" if value is MISSING else value for value in self.values[path])
            texts = (value if is_number(value) else clean(str(value)) for value in both)
            others.append((path, time, *differing_texts(*texts)))
        slight = self.sorted_slight()[:_MOST_OTHERS]
        first = {"t": others[0][1] if others else None, "paths": self.paths, "by_rarity": self.by_rarity}
        return first | {"others": others, "count": len(self.found), "slight": slight, "until": self.end}

    def compare(self, one: ValueHistory, other: ValueHistory, path: str) -> None:
        """Look for a difference in this value."""
        if self.by.is_log and not is_compared(path, self.by):
            return
        end = self.end if self.by.is_log or self.time is None else self.time
        left = list(_changes(one, path, self.begin, end))
        shifted = _changes(other, path, self.begin - self.offset, end - self.offset)
        right = [(time + self.offset, value) for time, value in shifted]
        if self.by.is_log and not _overlap(left, right):
            if any(value is not MISSING for _, value in right):
                self.never.add(path)
            return
        self.compared += 1
        if left == right:  # as most are
            return
        limits = self._limits(left, right)
        turn = next((each for each in _TURNS if each * (1 - _LESS) <= limits.range <= each + limits.rounding), math.inf)
        apart = partial(_apart, turn=turn, is_log=self.by.is_log)
        difference, (largest, moment) = self._difference(left, right, end, limits.most, apart)
        if difference is None:
            if largest > limits.rounding:
                self.slight[path] = largest / limits.range, moment
            return
        time, there, here = difference
        if self.by.is_log or self.time is None or time <= self.time:
            if not self.by.is_log and self.time is not None and time < self.time:
                self.found.clear()  # later ones do not matter
            self.found[path], self.values[path] = time, (there, here)
            self.changes[path] = max(len(left), len(right))

    def _difference(
        self, left: list[Held], right: list[Held], end: float, most: float, apart_of: Callable[..., float]
    ) -> tuple[tuple[float, Any, Any] | None, tuple[float, float]]:
        """Return the first moment at which the runs differ, with the values of the other run and of this one.

        Then, if there is none, how far they are apart at most, and when.

        :param most: how far values may be apart
        :param apart_of: returns how far two values are apart
        """
        late, largest = self.by.late, (0.0, 0.0)
        moments = sorted({time for time, _ in (*left, *right)})
        if late:  # a value that was there just before does not count for longer
            moments = sorted({*moments, *(time + late + _ROUNDING for time in moments)})
            moments = [time for time in moments if time <= end - late]
        lefts, rights = [time for time, _ in left], [time for time, _ in right]
        for time in moments:
            here, there = _at(left, lefts, time), _at(right, rights, time)
            if here is MISSING or there is MISSING:
                if here is not there and not self.by.is_log:
                    return (time, there, here), largest
                continue
            apart = apart_of(here, there)
            if late and apart > largest[0]:
                apart = max(
                    _apart_from(here, _between(right, rights, time, late), apart_of),
                    _apart_from(there, _between(left, lefts, time, late), apart_of),
                )
            if apart > most:
                return (time, there, here), largest
            if apart > largest[0]:
                largest = apart, time
        return None, largest

    def _limits(self, left: list[Held], right: list[Held]) -> _Limits:
        if not self.by.is_log or not self.by.share:
            return _Limits()
        whole = (value if isinstance(value, tuple) else (value,) for _, value in (*left, *right))
        numbers = [each for value in whole for each in value if is_number(each) and math.isfinite(each)]
        if not numbers:
            return _Limits()
        low, high = min(numbers), max(numbers)
        rounding = max(abs(low), abs(high), 1.0) * _SMALLEST
        return _Limits(max(self.by.share * (high - low), rounding), rounding, high - low)


class _Limits(NamedTuple):
    """How far the values of two runs may be apart.

    :param most: what does not count
    :param rounding: what is not even mentioned
    :param range: the largest number in both runs less the smallest one
    """

    most: float = 0.0
    rounding: float = 0.0
    range: float = 0.0


def _apart(one: Any, other: Any, turn: float, is_log: bool) -> float:
    """Return how far two values are apart; infinite: they differ, and are no numbers.

    :param turn: what is a whole turn, if they are angles; else infinite
    """
    if same(one, other):
        return 0.0
    if not is_log or one is MISSING or other is MISSING:
        return math.inf
    if is_number(one) and is_number(other):
        apart = float(abs(one - other))
        return abs(math.remainder(apart, turn)) if math.isfinite(apart) else math.inf
    if isinstance(one, tuple) and isinstance(other, tuple):
        parts = (_apart(*both, turn, is_log) for both in zip(one, other, strict=False))
        return max(parts, default=0.0) if len(one) == len(other) else math.inf
    return 0.0 if isinstance(one, str) != isinstance(other, str) else math.inf  # data logs have lists as texts


def is_compared(path: str, by: Comparison) -> bool:
    """Return whether a value is one that robot code sets, and compared; devices that never repeat are not."""
    if path in by.given or _GIVEN.match(path) or by.ignores(path):
        return False
    is_of_camera = path.startswith(VALUE) and camera_of(path.removeprefix(VALUE)) is not None
    return not (is_sensor(path) or is_of_camera or in_real_time(path))


def sensors_by_source(hal: ValueHistory, network: ValueHistory, given: frozenset[str]) -> dict[str, list[str]]:
    """Return the sensors of a run by where their values come from: ``log``, ``physics``, or ``nothing``.

    ``real time``: the devices that are simulated in real time, by name.

    :param hal: the values of `hal_data`
    :param network: those of NetworkTables, to which cameras belong
    :param given: the values that a log has
    """
    found: dict[str, list[str]] = {"log": [], "physics": [], "nothing": []}
    for path in sorted(path for path in network.now if camera_of(path.removeprefix(VALUE))):
        if path in given or network.moves(path):
            found["log" if path in given else "physics"].append(path)
    for path in sorted(hal.now):
        if is_sensor(path) and is_input(path, hal.now):
            found["log" if path in given else "physics" if hal.moves(path) else "nothing"].append(path)
    devices = dict.fromkeys(map(real_time_device, sorted(hal.now)))
    return found | {"real time": [device for device in devices if device is not None]}


def is_number(value: Any) -> bool:
    """Return whether a value is a number, and no boolean."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _apart_from(value: Any, others: list[Any], apart_of: Callable[..., float]) -> float:
    """Return how far a value is from the nearest of others; 0 for a number between them."""
    if is_number(value) and others and all(map(is_number, others)) and min(others) <= value <= max(others):
        return 0.0
    return min((apart_of(value, other) for other in others), default=math.inf)


def _overlap(left: list[Held], right: list[Held]) -> bool:
    """Return whether both have a value at the same time."""
    if left[0][1] is not MISSING and right[0][1] is not MISSING:
        return True
    lefts, rights = [time for time, _ in left], [time for time, _ in right]
    return any(_at(left, lefts, time) is not MISSING is not _at(right, rights, time) for time in (*lefts, *rights))


def _at(values: list[Held], times: list[float], time: float) -> Any:
    after = bisect_right(times, time + _ROUNDING)
    return values[after - 1][1] if after else MISSING


def _between(values: list[Held], times: list[float], time: float, late: float) -> list[Any]:
    """Return what a value is between `late` seconds before a moment and after it."""
    first = max(bisect_right(times, time - late + _ROUNDING) - 1, 0)
    found = (value for _, value in values[first : bisect_left(times, time + late + _ROUNDING)])
    return [value for value in found if value is not MISSING]


def _changes(history: ValueHistory, path: str, begin: float, end: float) -> Iterator[Held]:
    """Yield the value at the beginning, and each later change of it."""
    whole, index = resolve(history, path)
    before = picked(history.value_at(whole, begin), index)
    yield begin, before
    for time, each in zip(*history.changes(whole, begin, end), strict=True):
        value = picked(each, index)
        if not same(value, before):
            before = value
            yield time, value
