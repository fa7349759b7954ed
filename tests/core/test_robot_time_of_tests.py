"""The fixtures `fake_time` and `reraise`, and files of tests that are not collected; without a whole run of tests."""

from __future__ import annotations

import math
import threading
from pathlib import Path

import pytest
import wpilib
from loops import for_each

from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.test_support.fake_time import FakeTime, TestRanTooLong
from pyfrc_core.test_support.reraise import Reraise
from pyfrc_core.test_support.uncollected import find_uncollected


def test_time_advances_only_when_it_is_incremented(run: RobotRun) -> None:
    time = FakeTime(run)
    assert (time.get(), time.time_limit) == (0, 500)
    time.increment_time_by(0.03)
    time.increment_new_packet()
    assert time.get() == 0.04
    time.set_time_limit(None)
    assert time.time_limit is None
    time.reset()
    assert (time.get(), time.time_limit) == (0, 500)
    time.set_time_limit(0.5)
    time.increment_time_by(0.2)
    time.initialize()
    assert (time.get(), time.time_limit) == (0, 500)
    time.increment_time_by(500)
    with pytest.raises(TestRanTooLong):
        time.increment_new_packet()
    time.reset()
    time.set_time_limit(0.5)
    run.construct(wpilib.TimedRobot)
    run.start()
    with pytest.raises(TestRanTooLong):
        time.increment_time_by(0.6)


def test_time_cannot_be_set_back_while_the_robot_runs(run: RobotRun) -> None:
    run.construct(wpilib.TimedRobot)
    run.start()
    time = FakeTime(run)
    time.increment_time_by(0.02)
    for set_back in (time.initialize, time.reset):
        with pytest.raises(RuntimeError):
            set_back()
    assert time.get() == 0.02


@pytest.mark.parametrize("wrong", [-0.1, math.nan, math.inf, "1"])
def test_only_a_number_of_seconds_is_a_duration(wrong: float) -> None:
    time = FakeTime()
    with pytest.raises(ValueError, match=r"increment_time_by\(.*\): needs a number of seconds that is not negative$"):
        time.increment_time_by(wrong)
    with pytest.raises(ValueError, match=r"set_time_limit\(.*\): needs .* negative, or None for no limit$"):
        time.set_time_limit(wrong)


def in_thread(work: object) -> None:
    thread = threading.Thread(target=work)  # type: ignore[arg-type]
    thread.start()
    thread.join()


def test_the_first_error_of_any_thread_is_kept_and_raised_once() -> None:
    reraise, errors = Reraise(), [ValueError("first"), KeyError("second")]

    def fail() -> None:
        raise errors.pop(0)

    first = errors[0]
    assert reraise.reset() is None
    for _ in range(2):
        with pytest.raises((ValueError, KeyError)), reraise:
            fail()
    assert reraise.exception is first
    with pytest.raises(ValueError, match="first"):
        reraise()
    assert (reraise.exception, reraise.raised) == (None, first)
    reraise()
    errors[:] = [ValueError("caught"), KeyError("second")]
    caught = errors[0]
    with reraise(catch=True):
        fail()
    in_thread(reraise(catch=True).wrap(fail))  # type: ignore[union-attr]
    assert reraise.reset() is caught
    assert reraise.exception is None
    with reraise:
        pass
    assert reraise.wrap(len)("abc") == 3
    assert reraise.wrap(len).__name__ == "len"


@for_each(
    "name, text, sentence",
    [
        ("robot_tests.py", "def test_a(): pass", "its tests are not run, since pytest reads files called test_*.py"),
        ("robot_tests.py", "class TestA: pass", "Rename it to test_robot.py."),
        ("tests.py", "from pyfrc.tests import *", "Rename it to test_robot.py."),
        ("helper.py", "def helper(): pass", ""),
        ("conftest.py", "def test_a(): pass", ""),
        ("test_a.py", "x = 1", "no test was found in it. The name of a test begins with test_, as in: def test_drive("),
        ("test_a.py", "def drive_test():", "no test was found in it. The name of a test begins with test_: rename"),
        ("test_a.py", "\n# from pyfrc.tests import *", "Remove the # in line 2, for the ready-made tests."),
    ],
)
def test_files_of_which_no_test_runs(name: str, text: str, sentence: str, tmp_path: Path) -> None:
    directory = tmp_path / f"{abs(hash((name, text)))}" / "tests"
    directory.mkdir(parents=True)
    (directory / name).write_text(text)
    (directory / "test_good.py").write_text("def test_b(): pass")
    found = list(find_uncollected(directory, {directory / "test_good.py"}, ("test_*.py", "*_test.py")))
    assert len(found) == bool(sentence)
    assert all(each.startswith(f"tests/{name}: ") and sentence in each for each in found)
