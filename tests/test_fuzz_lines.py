"""Which lines and branches of the robot a match has reached, with `sys.monitoring` or a trace function."""

from __future__ import annotations

import importlib.util
import sys
import textwrap
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any

import pytest

from pyfrc_core.fuzz.guidance.goals import BRANCH, LINE, Goal, kind_of
from pyfrc_core.fuzz.guidance.lines import RobotLines
from pyfrc_core.project.robot_files import RobotFiles

MONITORS = sys.version_info >= (3, 12)

#: `play(3)` runs the lines that are marked with a plus.
ROBOT = """
    import sys
    import threading

    def count(most):
        for each in range(most):  # +
            yield each  # +
            if each > 100:  # +
                return
        most = 0  # +

    def fail(found):
        try:  # +
            raise KeyError(1)  # +
        except ValueError:  # +
            found.append("wrong")
        except KeyError as error:  # +
            found.append(error.args)  # +
        finally:
            found.append("end")  # +

    def in_thread(found):
        found.append("thread")  # +

    def never():
        return 1

    def play(number):
        found = []  # +
        thread = threading.Thread(target=in_thread, args=[found])  # +
        thread.start()  # +
        thread.join()  # +
        found += [each for each in count(number)]  # +
        fail(found)  # +

        def inner():  # +
            return number  # +

        while number:  # +
            number -= 1  # +
            if number == 50:  # +
                found.append(number)
        inner()  # +
        return found  # +

    def decide(number):
        if number > 5:
            return "high"
        return "low"

    def trace(tracer):
        sys.settrace(tracer)
        return 1
    """


@pytest.fixture
def robot(tmp_path: Path) -> ModuleType:
    file = tmp_path / "robot.py"
    file.write_text(textwrap.dedent(ROBOT))
    spec = importlib.util.spec_from_file_location("watched_robot", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def lines(robot: ModuleType, tmp_path: Path) -> RobotLines:
    return RobotLines(RobotFiles(tmp_path))


@contextmanager
def traced_by(tracer: Callable[..., Any] | None) -> Iterator[None]:
    before = sys.gettrace()
    sys.settrace(tracer)
    try:
        yield
    finally:
        sys.settrace(before)


def numbers(goals: Any) -> set[int]:
    return {goal[1] for goal in goals if kind_of(goal) == LINE}


def reached(lines: RobotLines, play: Callable[[], object], known: frozenset[Goal] = frozenset()) -> dict[Goal, int]:
    with traced_by(None), lines.watched(known, lambda: 7) as found:
        play()
    return dict(found)


def test_the_lines_of_threads_generators_and_handlers_are_found(robot: Any, lines: RobotLines) -> None:
    expected = {number for number, line in enumerate(textwrap.dedent(ROBOT).splitlines(), 1) if line.endswith("# +")}
    first = reached(lines, lambda: robot.play(3))
    assert numbers(first) == expected
    assert set(first.values()) == {7}
    assert numbers(first) < numbers(lines.all)
    # A second match finds the same, or what is left.
    assert reached(lines, lambda: robot.play(3)) == first
    assert reached(lines, lambda: robot.play(3), frozenset(first)) == {}
    some = frozenset(list(first)[::2])
    assert set(reached(lines, lambda: robot.play(3), some)) == set(first) - some


def test_functions_that_are_garbage_do_not_count(robot: Any, tmp_path: Path) -> None:
    robot.never.itself, robot.never = robot.never, None  # as what a decorator has replaced; only the collector frees it
    assert "never" not in {function.__name__ for function in RobotLines(RobotFiles(tmp_path)).functions}


def test_nothing_is_observed_afterwards(robot: Any, lines: RobotLines) -> None:
    with traced_by(None):
        with lines.watched(frozenset(), lambda: 0) as found:
            robot.decide(1)
        before = dict(found)
        robot.decide(9)
        assert found == before
        assert sys.gettrace() is None
        assert threading.gettrace() is None


if MONITORS:

    def test_each_way_of_a_branch_is_a_goal(robot: Any, lines: RobotLines) -> None:
        def branches(goals: Any) -> set[Goal]:
            return {goal for goal in goals if kind_of(goal) == BRANCH}

        low, high = reached(lines, lambda: robot.decide(1)), reached(lines, lambda: robot.decide(9))
        assert len(branches(low)) == len(branches(high)) == 1
        assert branches(low) != branches(high)
        both = reached(lines, lambda: [robot.decide(each) for each in (1, 1, 9, 9)])
        assert branches(both) == branches(low) | branches(high)
        assert reached(lines, lambda: [robot.decide(each) for each in (1, 9)], frozenset(low)) == {
            goal: 7 for goal in high if goal not in low
        }


def test_another_tool_that_traces_goes_on(robot: Any, lines: RobotLines) -> None:
    seen: set[int] = set()

    def tracer(frame: FrameType, event: str, argument: object) -> Any:
        if frame.f_code is robot.decide.__code__ and event == "line":
            seen.add(frame.f_lineno)
        return tracer

    with traced_by(tracer):
        with lines.watched(frozenset(), lambda: 0) as found:
            robot.decide(1)
        assert len(seen) == 2
        robot.decide(9)
        assert len(seen) == 3
        assert sys.gettrace() is tracer
    # Before Python 3.12, only one tool at a time can watch.
    assert len(numbers(found)) == (2 if MONITORS else 0)


def test_a_debugger_that_the_robot_starts_stays(robot: Any, lines: RobotLines) -> None:
    def debugger(frame: FrameType, event: str, argument: object) -> None:
        return None

    with traced_by(None):
        with lines.watched(frozenset(), lambda: 0):
            robot.trace(debugger)
        assert sys.gettrace() is debugger


if MONITORS:

    def test_a_tool_with_the_same_number_is_left_alone(robot: Any, lines: RobotLines) -> None:
        monitoring: Any = sys.monitoring  # type: ignore[attr-defined,unused-ignore]
        monitoring.use_tool_id(4, "another tool")
        try:
            assert reached(lines, lambda: robot.decide(1)) == {}
            assert monitoring.get_tool(4) == "another tool"
        finally:
            monitoring.free_tool_id(4)
