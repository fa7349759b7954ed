"""The report of a profile: text for people, JSON for programs."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from itertools import groupby
from typing import Any

from ..wording import counted, table
from .figures import CodeLine, Figures, Measurand, Overrun, distribution
from .stopwatch import WHOLE_LOOP
from .stopwatch_cost import Cost

#: How many of the robot times at which a function caused overruns are printed.
_TIMES = 4


def as_text(figures: Figures, cost: Cost, top: int) -> str:
    """Return the report to print.

    :param top: how many functions, and lines, to show
    """
    times = _by_total(figures)
    if not times:
        return "profile: no function of the robot was called"
    return "\n".join(
        [
            *_functions(times, top),
            *_loop(times, figures.period_ns),
            *_overruns(figures),
            *_lines(figures, top),
            *_cost(cost, figures.samples),
        ]
    )


def as_json(figures: Figures, cost: Cost, command: str) -> dict[str, Any]:
    """Return all measurements; the names contain the units."""
    return {
        "command": command,
        "period_ms": figures.period_ns / 1e6,
        "functions": [
            {
                **what._asdict(),
                "count": spread.count,
                "p50_ms": spread.p50,
                "p95_ms": spread.p95,
                "p99_ms": spread.p99,
                "max_ms": spread.longest,
                "total_ms": spread.total,
            }
            for what, spread in ((what, distribution(figures.times[what])) for what in _by_total(figures))
        ],
        "overruns": [
            {
                "robot_time_s": round(overrun.seconds, 6),
                "mode": overrun.mode,
                "function": overrun.culprit.name,
                "place": overrun.culprit.place,
                "loop_ms": overrun.took_ns / 1e6,
                "function_ms": overrun.culprit_ns / 1e6,
                "held_up_ms": overrun.held_up_ns / 1e6,
                "period_ms": overrun.period_ns / 1e6,
                "test": overrun.test,
            }
            for overrun in figures.overruns
        ],
        "lines": [
            {**line._asdict(), "computing_ms": computing / 1e6, "waiting_ms": waiting / 1e6}
            for line, (computing, waiting) in _slowest_lines(figures)
        ],
        "cost": {**asdict(cost), "share": cost.share, "samples": figures.samples},
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
        spread = distribution(times[what])
        numbers = (spread.p50, spread.p95, spread.p99, spread.longest)
        rows.append(
            (what.name, what.place, str(spread.count), *(f"{each:.3f}" for each in numbers), f"{spread.total:.1f}")
        )
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
        rows.append((what.name, *(_part_of(took, period) for took in (spread.p50, spread.p95, spread.longest))))
    yield from table(rows, left=1)
    p95 = distribution(periodic[WHOLE_LOOP]).p95
    if 0 < p95 < period:
        factor = _rounded_down(period / p95)
        yield f"  19 of 20 turns would be in time on a computer that is up to {factor} times slower."
    yield "  A roboRIO is slower than this computer. By how much has not been measured."


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
        first, worst = group[0], max(group, key=lambda overrun: overrun.culprit_ns)
        rows.append(
            (
                first.culprit.name,
                first.culprit.place,
                first.mode,
                str(len(group)),
                f"{worst.culprit_ns / 1e6:.1f} ms",
                f"{worst.held_up_ns / 1e6:.1f} ms",
                f"{first.period_ns / 1e6:g} ms",
                _moments(group),
            )
        )
    yield from table(rows, left=3, left_at_end=1)
    if any(overrun.held_up_ns > overrun.took_ns / 2 for overrun in figures.overruns):
        in_time = sum(overrun.took_ns - overrun.held_up_ns <= overrun.period_ns for overrun in figures.overruns)
        yield "  Held up: the computer ran another program then, or the robot's code waited for something outside."
        yield f"  Without that, {in_time:,} of these turns would have been in time."


def _grouped(overruns: Iterable[Overrun]) -> list[list[Overrun]]:
    """Group the overruns by function and mode, the most frequent first."""

    def same(overrun: Overrun) -> tuple[Measurand, str, int]:
        return overrun.culprit, overrun.mode, overrun.period_ns

    groups = [list(group) for _, group in groupby(sorted(overruns, key=same), same)]
    return sorted(groups, key=len, reverse=True)


def _moments(overruns: Sequence[Overrun]) -> str:
    moments = sorted({round(overrun.seconds, 2) for overrun in overruns})
    text = ", ".join(f"{moment:.2f}" for moment in moments[:_TIMES])
    return f"{text} s" if len(moments) <= _TIMES else f"{text}, ... {moments[-1]:.2f} s"


def _lines(figures: Figures, top: int) -> Iterator[str]:
    slowest = _slowest_lines(figures)
    if not slowest:
        return
    yield ""
    yield "The lines that took longest, in milliseconds, by samples:"
    rows = [("line", "function", "computing", "waiting")]
    rows += [
        (line.place, line.function, f"{computing / 1e6:.1f}", f"{waiting / 1e6:.1f}")
        for line, (computing, waiting) in slowest[:top]
    ]
    yield from table(rows, left=2)


def _slowest_lines(figures: Figures) -> list[tuple[CodeLine, list[int]]]:
    return sorted(figures.lines.items(), key=lambda item: (-sum(item[1]), item[0]))


def _cost(cost: Cost, samples: int) -> Iterator[str]:
    yield ""
    parts = [f"{cost.timing_ns / 1e6:.1f} ms for timing ({cost.call_ns / 1e3:.2f} µs a call)"]
    parts.append(f"{cost.sampling_ns / 1e6:.1f} ms for {counted(samples, 'sample')}")
    if cost.profiled_calls:
        calls = counted(cost.profiled_calls, "call")
        parts.append(f"{cost.calls_ns / 1e6:.1f} ms for {calls} in cProfile, which the times above include")
    text = f"Cost of measuring: {', '.join(parts)}"
    if cost.share is not None:
        robot_ms = (cost.robot_ns / 1e6) / (1 + cost.share)
        text += f"; {cost.share:.0%} of the {robot_ms:.1f} ms that the robot took without it"
    yield text + "."
