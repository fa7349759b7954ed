"""The verdict about a started program, from processes and output at given times, without a clock or processes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from loops import for_each

from pyfrc_core.deploy.agent.start_monitor import ENDED, RUNNING, STARTED, STARTING, UNHEARD, StartMonitor

LIMIT, SILENT_LIMIT = 60.0, 20.0
OLD = 100
BEGINNING = "12:00:00:000 INFO    : wpilib              : WPILib version 2026.2.2\n"
TRACEBACK = 'Traceback (most recent call last):\n  File "robot.py", line 3, in robotInit\nRuntimeError: no\n'
OVER = "12:00:01:000 ERROR   : robotpy             : The robot program quit unexpectedly. This is usually due to\n"
COMPLETE = f"********** {STARTED} **********\n"


@dataclass(frozen=True)
class Program:
    """How a robot program behaves, and how the robot treats it; times in seconds from the start of its process.

    :param crashes:  when it ends; none: it lives on
    :param starts:   when it reports that it has started; none: never
    :param console:  whether its output arrives
    :param pause:    of the supervisor, before it starts the program again
    :param late:     how late output arrives
    :param catches:  when it prints a traceback of an error that it has caught
    :param announced: whether WPILib prints its version at the start
    """

    crashes: float | None = None
    starts: float | None = None
    console: bool = True
    pause: float = 0.0
    late: float = 0.0
    catches: float | None = None
    announced: bool = True


@dataclass(frozen=True)
class Judged:
    verdict: str
    seconds: float


def looks(program: Program, turn: float, script: float, gap: float) -> Iterator[tuple[float, set[int], str]]:
    """What is seen of it: the time, the processes, the text since the last look."""
    lives: list[tuple[float, float]] = []  # of one process after the other
    begin = gap
    while begin < script + LIMIT + 20:
        end = begin + program.crashes if program.crashes is not None else float("inf")
        lives.append((begin, end))
        begin = end + program.pause
    prints: list[tuple[float, str]] = []
    for begin, end in lives:
        at = [(begin + 0.1, BEGINNING)] if program.announced else []
        at += [(begin + program.starts, COMPLETE)] if program.starts is not None else []
        at += [(begin + program.catches, TRACEBACK)] if program.catches is not None else []
        prints += [(when + program.late, text) for when, text in at if when < end]
        if end != float("inf"):
            prints.append((end + program.late - 0.01, TRACEBACK + OVER))
    prints = sorted(prints, key=lambda each: each[0]) if program.console else []
    before, now = 0.0, 0.0
    while True:
        alive = {OLD + 1 + number for number, (begin, end) in enumerate(lives) if begin <= now < end}
        yield now, alive or ({OLD} if now < gap else set()), "".join(text for at, text in prints if before <= at < now)
        before, now = now, now + turn


def judge(program: Program, *, turn: float = 0.1, script: float = 0.05, gap: float = 0.02) -> Judged:
    """Watch it to the verdict.

    :param script: when the robot's kill script ends
    :param gap:    when the old process has ended, and the new one begins
    """
    monitor = StartMonitor({OLD})
    script_over = False
    for now, processes, text in looks(program, turn, script, gap):
        monitor.observe(now, processes, text)
        if now >= script and not script_over:
            monitor.restarted(now)
            script_over = True
        verdict = monitor.verdict(now, LIMIT, SILENT_LIMIT)
        if verdict is not None:
            return Judged(verdict, now)
    raise AssertionError


def test_a_slow_start_is_neither_running_nor_ended() -> None:
    assert judge(Program(starts=65.0)) == Judged(STARTING, pytest.approx(60.0, abs=0.2))
    assert judge(Program()).verdict == STARTING


def feed(*looks: tuple[float, set[int], str], end: float, old: int = OLD) -> tuple[StartMonitor, str | None]:
    """A monitor that has seen all of this, restarted at 0, and its verdict at `end`."""
    monitor = StartMonitor({old})
    monitor.observe(-1.0, {old})
    monitor.observe(-0.5, set())
    monitor.restarted(0.0)
    for now, processes, text in looks:
        monitor.observe(now, processes, text)
    return monitor, monitor.verdict(end, LIMIT, SILENT_LIMIT)


def test_how_long_a_program_that_has_started_has_to_live_on() -> None:
    """The agent waits no longer than that for the next look."""
    assert feed((1.0, {101}, BEGINNING), end=2.0)[0].trial_left(2.0) is None
    monitor, verdict = feed((1.0, {101}, BEGINNING), (3.0, {101}, COMPLETE), end=3.75)
    assert (monitor.trial_left(3.75), verdict) == (0.25, None)
    assert monitor.trial_left(4.0) == 0
    assert monitor.verdict(4.0, LIMIT, SILENT_LIMIT) == RUNNING
    monitor, _ = feed((1.0, {101}, BEGINNING), (3.0, {101}, COMPLETE + TRACEBACK), end=4.0)
    assert monitor.trial_left(4.0) == 2.0, "longer after a traceback"
    monitor.observe(5.0, {101}, OVER)
    assert monitor.trial_left(9.0) is None, "its end is known"


def test_a_thread_that_outlives_the_program_keeps_nothing_alive_but_the_process() -> None:
    _, verdict = feed((1.0, {101}, ""), (2.0, {101}, BEGINNING + COMPLETE), (2.1, {101}, TRACEBACK + OVER), end=9.0)
    assert verdict == ENDED


def test_how_long_the_program_lived() -> None:
    looks = [(1.0, {101}, ""), (4.5, {102}, TRACEBACK), (4.7, {103}, TRACEBACK)]
    assert feed(*looks, end=6.0)[0].lived == 3.5, "not that of the next one"
    looks = [(1.0, {101}, ""), (2.0, {101}, BEGINNING), (3.5, {101}, TRACEBACK + OVER), (3.9, {101}, "")]
    assert feed(*looks, end=6.0)[0].lived == 2.5, "although a thread keeps the process"


def test_other_processes_of_the_program_may_come_and_go() -> None:
    """It may fork, or start another Python on a file of its own."""
    looks = [(1.0, {101}, BEGINNING), (2.0, {101, 105}, ""), (3.0, {101}, COMPLETE), (4.0, {101, 109}, "")]
    assert feed(*looks, end=6.0)[1] == RUNNING
    # What it leaves behind is not the program.
    monitor, verdict = feed(*looks, (4.1, {109}, ""), end=5.0)
    assert verdict == ENDED
    assert monitor.process is None


def test_a_program_that_is_started_twice_by_a_restart_has_not_crashed() -> None:
    """By the supervisor, when the old one ends, and by the kill script."""
    monitor, verdict = feed((0.1, {101}, ""), (0.8, {102}, ""), (2.0, {102}, BEGINNING + COMPLETE), end=5.0)
    assert verdict == RUNNING
    assert monitor.process == 102
    assert feed((0.1, {101}, ""), (0.8, {102}, ""), (1.5, {103}, ""), end=5.0)[1] == ENDED
    assert feed((0.1, {101}, BEGINNING), (0.7, {101}, TRACEBACK), (0.8, {102}, ""), end=5.0)[1] == ENDED


def test_output_of_the_old_program_does_not_count_for_the_new_one() -> None:
    monitor = StartMonitor({OLD})
    monitor.observe(0.0, {OLD}, BEGINNING + COMPLETE)
    monitor.observe(0.1, {OLD}, TRACEBACK + OVER)
    monitor.observe(0.2, {101}, COMPLETE + TRACEBACK + OVER)
    monitor.observe(0.3, {101}, OVER)
    monitor.restarted(0.3)
    monitor.observe(5.0, {101})
    assert monitor.verdict(5.0, LIMIT, SILENT_LIMIT) is None
    monitor.observe(6.0, {101}, BEGINNING)
    monitor.observe(7.0, {101}, COMPLETE)
    assert monitor.verdict(10.0, LIMIT, SILENT_LIMIT) == RUNNING


def test_output_of_a_crashed_process_does_not_count_for_the_next_one() -> None:
    """All within the two seconds of the kill script."""
    monitor = StartMonitor({OLD})
    monitor.observe(0.0, {OLD})
    monitor.observe(0.1, {101}, BEGINNING)
    monitor.observe(0.5, {101}, COMPLETE)
    monitor.observe(0.9, {102}, TRACEBACK + OVER)
    monitor.restarted(2.0)
    monitor.observe(4.0, {102})
    assert monitor.verdict(4.0, LIMIT, SILENT_LIMIT) is None
    monitor.observe(5.0, {103})
    assert monitor.verdict(6.0, LIMIT, SILENT_LIMIT) == ENDED
    assert monitor.lived == pytest.approx(5.0 - 0.9)


@for_each("output, seconds", [("", 10.0), (TRACEBACK, 2.0)])
def test_a_program_that_never_appears(output: str, seconds: float) -> None:
    assert feed((0.5, set(), output), end=seconds - 0.1)[1] is None
    monitor, verdict = feed((0.5, set(), output), end=seconds + 0.1)
    assert verdict == ENDED
    assert not monitor.seen


def test_without_patience_there_is_a_verdict_at_once() -> None:
    monitor = StartMonitor(())
    monitor.restarted(0.0)
    assert monitor.verdict(0.0, 0.0, 0.0) == ENDED
    monitor.observe(0.0, {1}, "words\n")
    assert monitor.verdict(0.0, 0.0, 0.0) == STARTING


#: But for the second before the limit of a silent program: either verdict is right there.
SECONDS = st.floats(0.4, 18.5) | st.floats(21.0, 25.0)
HOW = {
    "turn": st.floats(0.02, 0.25),
    "script": st.floats(0.0, 3.0),
    "gap": st.floats(0.0, 2.0),
}
PROGRAMS = st.builds(
    Program,
    crashes=st.none(),
    starts=st.none() | SECONDS,
    console=st.booleans(),
    pause=st.floats(0.0, 2.0),
    late=st.floats(0.0, 0.2),
    catches=st.none() | SECONDS,
    announced=st.booleans(),
)


# A start that is reported soon after the process was first seen, long after the end of the old one.
@example(
    Program(starts=0.40234375, console=True, pause=0.0, late=0.0, announced=False),
    {"turn": 0.21875, "script": 0.0, "gap": 2.0},
)
@given(PROGRAMS, st.fixed_dictionaries(HOW))
def test_a_program_that_lives_on_is_never_called_ended(program: Program, how: dict[str, float]) -> None:
    how["script"] = max(how["script"], how["gap"])  # the script ends after the old program
    verdict = judge(program, **how).verdict
    first_words = min(seconds for seconds in (program.starts, program.catches, 1000.0) if seconds is not None)
    if not program.console or (not program.announced and first_words > SILENT_LIMIT - 1.0):
        assert verdict == UNHEARD
    else:
        assert verdict == (STARTING if program.starts is None else RUNNING)


@given(PROGRAMS, st.floats(0.4, 16.0), st.fixed_dictionaries(HOW))
def test_a_program_that_crashes_in_robot_init_is_never_called_running(
    program: Program, crashes: float, how: dict[str, float]
) -> None:
    how["script"] = max(how["script"], how["gap"])
    assert judge(replace(program, crashes=crashes, starts=None), **how).verdict == ENDED


@given(PROGRAMS, st.floats(0.4, 16.0), st.floats(0.0, 0.5), st.fixed_dictionaries(HOW))
def test_a_program_that_crashes_right_after_its_start_is_never_called_running(
    program: Program, starts: float, after: float, how: dict[str, float]
) -> None:
    how["script"] = max(how["script"], how["gap"])
    assert judge(replace(program, starts=starts, crashes=starts + after), **how).verdict == ENDED


@for_each("dies", [None, 6.0])
def test_a_program_that_reports_no_start_is_judged_by_its_process(dies: float | None) -> None:
    """As `magicbot.MagicRobot`, which has a loop of its own."""
    monitor = StartMonitor((), reports=lambda: False)
    monitor.restarted(0.0)
    now, verdict = 0.0, None
    while verdict is None:
        now += 0.1
        process = 1 if dies is None or now < dies else int(now / dies) + 1
        monitor.observe(now, {process}, "a line\n")
        verdict = monitor.verdict(now, LIMIT, SILENT_LIMIT)
    assert (verdict, round(now)) == (UNHEARD, SILENT_LIMIT) if dies is None else (ENDED, 6)
