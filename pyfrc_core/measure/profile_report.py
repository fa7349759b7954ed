"""The report of a profile: text for people, and JSON for programs."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ..season import CURRENT
from ..wording import counted, table
from .figures import WHOLE_LOOP, Figures, Measurand, Overrun, distribution

#: How many of the robot times at which a function caused overruns are printed.
_TIMES = 4


def as_text(figures: Figures, top: int) -> str:
    """Return the report to print.

    :param top: how many functions to show
    """
    times = _by_total(figures)
    if not times:
        return "profile: no function of the robot was called"
    return "\n".join([*_functions(times, top), *_loop(times, figures.period_ns), *_overruns(figures)])


def as_json(figures: Figures, command: str) -> dict[str, Any]:
    """Return all measurements; the names contain the units."""
    return {
        "command": command,
        "period_ms": figures.period_ns / 1e6,
        "functions": [what._asdict() | vars(distribution(times)) for what, times in _by_total(figures).items()],
        "overruns": [overrun._asdict() for overrun in figures.overruns],
    }


def _by_total(figures: Figures) -> dict[Measurand, Any]:
    """Return the functions that were called: the loop first, then by the total time of all calls."""
    called = {what: times for what, times in figures.times.items() if len(times)}
    order = sorted(called, key=lambda what: (what != WHOLE_LOOP, -sum(called[what]), what))
    return {what: called[what] for what in order}


def _functions(times: dict[Measurand, Any], top: int) -> Iterator[str]:
    yield "How long each call took, in milliseconds of processor time, and of robot time while it waited:"
    rows: list[tuple[str, ...]] = [("function", "place", "calls", "p50", "p95", "p99", "max", "total")]
    for what in list(times)[:top]:
        count, *numbers, total = vars(distribution(times[what])).values()
        rows.append((what.name, what.place, str(count), *(f"{each:.3f}" for each in numbers), f"{total:.1f}"))
    yield from table(rows, left=2)
    if len(times) > top:
        yield f"  and {counted(len(times) - top, 'more function')} (--top {len(times)})"


def _loop(times: Mapping[Measurand, array[int]], period_ns: int) -> Iterator[str]:
    """Yield how long each periodic function takes, and how much of the loop's period that is."""
    periodic = {what: each for what, each in times.items() if _is_periodic(what)}
    if WHOLE_LOOP not in periodic or not period_ns:
        return
    period = period_ns / 1e6
    yield ""
    yield f"The loop has {period:g} ms for each packet. Of these, on this computer:"
    rows: list[tuple[str, ...]] = [("function", "median", "95th percentile", "most")]
    for what, each in periodic.items():
        spread = distribution(each)
        rows.append((what.name, *(_part_of(took, period) for took in (spread.p50_ms, spread.p95_ms, spread.max_ms))))
    yield from table(rows, left=1)
    p95 = distribution(periodic[WHOLE_LOOP]).p95_ms
    if 0 < p95 < period:
        factor = _rounded_down(period / p95)
        yield f"  19 of 20 turns would be in time on a computer that is up to {factor} times slower."
    yield f"  A {CURRENT.controller.name} is slower than this computer. By how much has not been measured."


def _is_periodic(what: Measurand) -> bool:
    """Return whether a function is called once in each turn of the loop, or of its mode."""
    name = what.name.rpartition(".")[2]
    return (
        what == WHOLE_LOOP
        or (what.kind == "robot" and name.endswith("Periodic"))
        or (what.kind == "subsystem" and name == "periodic")
        or (what.kind == "component" and name == "execute")
    )


def _part_of(took: float, period: float) -> str:
    return f"{took:.3f} ms {took / period:6.1%}"


def _rounded_down(factor: float) -> str:
    return f"{int(factor)}" if factor >= 10 else f"{int(factor * 10) / 10:g}"


def _overruns(figures: Figures) -> Iterator[str]:
    yield ""
    if not figures.overruns:
        yield "No turn of the loop took longer than its period."
        return
    yield f"{counted(len(figures.overruns), 'turn')} of a loop took longer than its period:"
    rows = [("function", "place", "mode", "times", "worst", "held up", "period", "at robot time")]
    for group in _grouped(figures.overruns):
        first, worst = group[0], max(group, key=lambda overrun: overrun.function_ms)
        times = f"{worst.function_ms:.1f} ms", f"{worst.held_up_ms:.1f} ms", f"{first.period_ms:g} ms"
        rows.append((first.function, first.place, first.mode, str(len(group)), *times, _moments(group)))
    yield from table(rows, left=3, left_at_end=1)
    if any(overrun.held_up_ms > overrun.loop_ms / 2 for overrun in figures.overruns):
        in_time = sum(overrun.loop_ms - overrun.held_up_ms <= overrun.period_ms for overrun in figures.overruns)
        yield "  Held up: the computer ran another program then, or the robot's code waited for something outside."
        yield f"  Without that, {in_time:,} of these turns would have been in time."


def _grouped(overruns: Iterable[Overrun]) -> list[list[Overrun]]:
    """Group the overruns by function and mode, the most frequent first."""
    groups: dict[object, list[Overrun]] = {}
    for overrun in overruns:
        groups.setdefault((overrun.function, overrun.place, overrun.mode, overrun.period_ms), []).append(overrun)
    return sorted(groups.values(), key=len, reverse=True)


def _moments(overruns: Sequence[Overrun]) -> str:
    moments = sorted({round(overrun.robot_time_s, 2) for overrun in overruns})
    text = ", ".join(f"{moment:.2f}" for moment in moments[:_TIMES])
    return f"{text} s" if len(moments) <= _TIMES else f"{text}, ... {moments[-1]:.2f} s"
