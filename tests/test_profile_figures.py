"""The figures of a profile: percentiles are times that were measured, and processes' figures add up."""

from __future__ import annotations

from array import array
from pathlib import Path

import pytest
import wpilib
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each

from pyfrc_core.measure.figures import Figures, Measurand, Overrun, added_up, distribution
from pyfrc_core.measure.profile_report import as_json, as_text
from pyfrc_core.wpi import callbacks

TELEOP = Measurand("robot", "MyRobot.teleopPeriodic", "robot.py:3")
LOOP = Measurand("loop", "the whole loop", "")

times = st.lists(st.integers(0, 10**12), min_size=1, max_size=300)


@given(times)
def test_at_least_so_many_calls_took_no_longer_than_a_percentile(nanoseconds: list[int]) -> None:
    spread = distribution(array("q", nanoseconds))
    for percent, percentile in ((50, spread.p50_ms), (95, spread.p95_ms), (99, spread.p99_ms)):
        no_longer = sum(each / 1e6 <= percentile for each in nanoseconds)
        shorter = sum(each / 1e6 < percentile for each in nanoseconds)
        assert percentile in {each / 1e6 for each in nanoseconds}
        assert 100 * no_longer >= percent * len(nanoseconds) > 100 * shorter
    assert spread.max_ms == max(nanoseconds) / 1e6
    assert spread.count == len(nanoseconds)


@given(st.lists(times, min_size=1, max_size=5))
def test_what_processes_kept_adds_up(tmp_path_factory: pytest.TempPathFactory, processes: list[list[int]]) -> None:
    directory = tmp_path_factory.mktemp("figures")
    files: list[Path] = []
    for number, nanoseconds in enumerate(processes):
        figures = Figures()
        figures.times_of(TELEOP).extend(nanoseconds)
        files.append(directory / f"{number}.figures")
        figures.save(files[-1])
    total = added_up(files)
    assert list(total.times[TELEOP]) == [each for nanoseconds in processes for each in nanoseconds]


def overrun(seconds: float, mode: str, took: float, held_up: float = 0.0) -> Overrun:
    """One of 20 ms."""
    return Overrun(seconds, mode, TELEOP.name, TELEOP.place, took, took, held_up, 20.0, "")


def test_the_report_groups_overruns_and_says_when_they_were() -> None:
    figures = Figures()
    figures.times_of(LOOP).extend([31_000_000] * 7)
    figures.times_of(TELEOP).extend([30_000_000] * 6 + [1_000_000])
    figures.overruns += [overrun(second, "teleop", 30 + second) for second in range(6)]
    figures.overruns.append(overrun(9.5, "test", 40, held_up=39))
    text = as_text(figures, top=1)
    lines = [" ".join(line.split()) for line in text.splitlines()]
    assert lines[1:3] == [
        "function place calls p50 p95 p99 max total",
        "the whole loop 7 31.000 31.000 31.000 31.000 217.0",
    ]
    assert "and 1 more function (--top 2)" in lines
    assert "7 turns of a loop took longer than its period:" in lines
    teleop = "MyRobot.teleopPeriodic robot.py:3 teleop 6 35.0 ms 0.0 ms 20 ms 0.00, 1.00, 2.00, 3.00, ... 5.00 s"
    assert lines[lines.index(teleop) - 1] == "function place mode times worst held up period at robot time"
    assert "MyRobot.teleopPeriodic robot.py:3 test 1 40.0 ms 39.0 ms 20 ms 9.50 s" in lines
    assert lines.index(teleop) + 2 == next(at for at, line in enumerate(lines) if line.startswith("Held up:"))
    assert "Without that, 1 of these turns would have been in time." in lines


def test_the_report_says_how_much_of_the_period_each_periodic_function_takes() -> None:
    figures = Figures(period_ns=20_000_000)
    figures.times_of(LOOP).extend([2_000_000] * 9 + [4_000_000] * 10 + [30_000_000])
    figures.times_of(TELEOP).extend([1_000_000])
    for kind, name in (("command", "Lift.execute"), ("command", "Arm.periodic"), ("robot", "A.robotInit")):
        figures.times_of(Measurand(kind, name, "")).extend([900_000])
    for kind, name in (("subsystem", "Arm.periodic"), ("component", "Lift.execute")):
        figures.times_of(Measurand(kind, name, "robot.py:9")).extend([800_000])
    text = as_text(figures, top=1).partition("The loop has 20 ms for each packet.")[2]
    lines = [" ".join(line.split()) for line in text.splitlines()]
    assert lines[1:8] == [
        "function median 95th percentile most",
        "the whole loop 4.000 ms 20.0% 4.000 ms 20.0% 30.000 ms 150.0%",
        "MyRobot.teleopPeriodic 1.000 ms 5.0% 1.000 ms 5.0% 1.000 ms 5.0%",
        "Lift.execute 0.800 ms 4.0% 0.800 ms 4.0% 0.800 ms 4.0%",
        "Arm.periodic 0.800 ms 4.0% 0.800 ms 4.0% 0.800 ms 4.0%",
        "19 of 20 turns would be in time on a computer that is up to 5 times slower.",
        "A roboRIO is slower than this computer. By how much has not been measured.",
    ]


@for_each("took, factor", [(12, "1.6"), (10, "2"), (2, "10"), (0.93, "21")])
def test_how_much_slower_a_computer_may_be_is_not_overstated(took: float, factor: str) -> None:
    figures = Figures(period_ns=20_000_000)
    figures.times_of(LOOP).append(int(took * 1e6))
    assert f"up to {factor} times slower." in as_text(figures, top=1)


def test_a_loop_that_is_too_slow_here_is_not_compared_with_a_slower_computer() -> None:
    figures = Figures(period_ns=20_000_000)
    figures.times_of(LOOP).append(30_000_000)
    assert "times slower" not in as_text(figures, top=1)


def test_all_of_it_is_in_the_json() -> None:
    figures = Figures()
    figures.times_of(TELEOP).append(30_000_000)
    figures.overruns.append(overrun(1.02, "teleop", 30))
    report = as_json(figures, "pyfrc test")
    assert report["command"] == "pyfrc test"
    assert report["functions"][0]["p99_ms"] == 30
    assert report["overruns"][0] == {
        "robot_time_s": 1.02,
        "mode": "teleop",
        "function": "MyRobot.teleopPeriodic",
        "place": "robot.py:3",
        "loop_ms": 30,
        "function_ms": 30,
        "held_up_ms": 0,
        "period_ms": 20,
        "test": "",
    }


def test_nothing_measured_is_said() -> None:
    assert "no function of the robot was called" in as_text(Figures(), top=5)


def test_of_a_robot_with_its_own_loop_all_but_the_loop_may_be_called() -> None:
    class Own(wpilib.RobotBase):
        def startCompetition(self) -> None: ...
        def endCompetition(self) -> None: ...
        def turn(self) -> None: ...

    assert callbacks.called_methods(Own) == ("robot", {"turn"})
    assert callbacks.called_methods(Path) == ("", frozenset())
