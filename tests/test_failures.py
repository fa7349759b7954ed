"""Failures as a student meets them: their own file and line first, what happened, what to do; and the exit code."""

from __future__ import annotations

import re
import sys

import pytest
from conftest import MakeProject, Result, RobotProject
from loops import for_each
from spelling import spelled

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""

# One robot that can get into any kind of trouble, one test for each, all in one run.
TROUBLED_ROBOT = """
    import ctypes
    import os
    import sys
    import threading
    import time

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        trouble_in_init = None
        trouble_in_robot_init = None

        def __init__(self):
            super().__init__()
            self.trouble = None
            if self.trouble_in_init:
                raise ValueError("no such arm")

        def robotInit(self):
            if self.trouble_in_robot_init:
                self.arm.raise_it()

        def teleopPeriodic(self):
            if self.trouble:
                getattr(self, self.trouble)()

        # -- the troubles

        def divides_by_zero(self):
            helped_by_another_method(0)

        def loops_forever(self):
            count = 0
            while True:  # forever
                count += 1  # and ever

        def loops_forever_whatever_happens(self):
            while True:  # whatever happens
                try:
                    while True:
                        self.count = 1
                except Exception:
                    pass  # it goes on

        def loops_in_a_thread(self):
            self.in_a_thread(self.loop_of_the_thread)

        def loop_of_the_thread(self):
            count = 0
            while True:  # in the thread
                count += 1  # on and on

        def fails_in_a_thread(self):
            self.in_a_thread(self.failure_of_the_thread)

        def failure_of_the_thread(self):
            raise RuntimeError("the camera is gone")

        def will_not_stop(self):
            self.in_a_thread(self.sleeps_on, name="stubborn")

        def sleeps_on(self):
            while True:  # stubborn
                try:
                    time.sleep(0.1)
                except BaseException:
                    pass  # not to be told

        def fails_in_a_notifier(self):
            self.trouble = None
            self.notifier = wpilib.Notifier(self.callback)
            self.notifier.startSingle(0.1)

        def callback(self):
            raise LookupError("no target")

        def in_a_thread(self, function, name=None):
            self.trouble = None
            self.thread = threading.Thread(target=function, name=name, daemon=True)
            self.thread.start()

        def leaves(self):
            print("said before leaving")
            os._exit(3)

        def segfaults(self):
            print("said before the fault")
            ctypes.string_at(0)

        def exits(self):
            sys.exit("enough")


    def helped_by_another_method(number):
        return 1 / number
"""

#: As signals are named, and exit codes of Windows.
FAULT = "access violation" if sys.platform == "win32" else "segmentation fault"

TROUBLED_TESTS = """
    import pytest

    from robot import MyRobot

    TROUBLES = [name for name in vars(MyRobot) if name.split("_")[0] in {
        "divides", "loops", "fails", "will", "leaves", "segfaults", "exits"
    }]


    @pytest.mark.parametrize("trouble", TROUBLES)
    def test_teleop(control, robot, trouble):
        robot.trouble = trouble
        control.set_operator_control(enabled=True)
        control.run_test(lambda tm: tm < 1)


    @pytest.fixture
    def in_init(monkeypatch):
        monkeypatch.setattr(MyRobot, "trouble_in_init", True)


    def test_init(in_init, control):
        control.run_test(lambda tm: tm < 1)


    def test_robot_init(control, robot):
        robot.trouble_in_robot_init = True
        control.run_test(lambda tm: tm < 1)


    def test_assertion(control, hal_data):
        control.run_test(lambda tm: tm < 1)
        assert hal_data["pwm"][3]["value"] == 0.25  # asserted


    def test_assertion_in_on_step(control):
        def on_step(tm):
            assert tm < 0.5  # asserted in a step
            return True

        control.run_test(on_step)


    def test_wrong_key(hal_data):
        hal_data["pwm"][0]["valeu"] = 1


    def test_wrong_top_key(hal_data):
        hal_data["pmw"]


    def test_run_twice(control):
        control.run_test(lambda tm: tm < 1)
        control.run_test(lambda tm: tm < 2)  # again


    def test_nothing_to_run(control):
        control.run_test()


    def test_practice_match_too_late(control):
        control.run_test(lambda tm: tm < 1)
        control.set_practice_match()


    def test_too_long(control, fake_time):
        fake_time.set_time_limit(5)
        control.run_test(lambda tm: True)


    def test_fine(control):
        control.run_test(lambda tm: tm < 1)
"""

HANGS_SOON = """
    [tool.pyfrc.test]
    hang_seconds = 0.25
"""


@pytest.fixture(scope="module")
def troubled(make_shared_project: MakeProject) -> RobotProject:
    return make_shared_project(
        {"robot.py": TROUBLED_ROBOT, "tests/test_troubles.py": TROUBLED_TESTS, "pyproject.toml": HANGS_SOON}
    )


@pytest.fixture(scope="module")
def report(troubled: RobotProject) -> Result:
    """The one run of all of the troubled robot's tests."""
    return troubled.run("test", "-j", "2")


def first_line(block: str) -> str:
    return block.partition("\n")[0]


def number_in(line: str, file: str) -> int:
    """The line number of ``file:12: what happened``, with which a failure begins."""
    place = re.match(rf"{re.escape(file)}:(\d+): ", line)
    assert place is not None, f"{line!r} does not begin with a line of {file}"
    return int(place[1])


# -- what goes wrong while the robot runs ---------------------------------------------------------------------------


def test_a_run_with_failures_exits_with_1_and_tells_each(report: Result) -> None:
    assert report.code == 1, report.output
    assert "INTERNALERROR" not in report.output
    assert "test_fine" not in report.output


@pytest.mark.parametrize(
    ("test", "line", "text"),
    [
        ("test_teleop[divides_by_zero]", "return 1 / number", "ZeroDivisionError: division by zero"),
        pytest.param(
            "ERROR at setup of test_init", "no such arm", "ValueError: no such arm", marks=pytest.mark.season_2026
        ),
        pytest.param(
            "test_robot_init",
            "self.arm.raise_it()",
            "AttributeError: 'MyRobot' object has no attribute 'arm'",
            marks=pytest.mark.season_2026,
        ),
        ("test_teleop[fails_in_a_thread]", "the camera is gone", "RuntimeError: the camera is gone"),
        ("test_teleop[fails_in_a_notifier]", "no target", "LookupError: no target"),
        ("test_teleop[exits]", "sys.exit(", "SystemExit: enough"),
    ],
)
def test_an_exception_names_the_robots_line_first(
    report: Result, troubled: RobotProject, test: str, line: str, text: str
) -> None:
    block = report.blocks()[test]
    assert first_line(block) == f"{troubled.place('robot.py', line)}: {text}"
    assert line in block.partition("\n")[2]  # the code, too


@for_each(
    "test, line, text",
    [
        ("test_assertion", "== 0.25", "AssertionError: assert 0.0 == 0.25"),
        ("test_assertion_in_on_step", "# asserted in a step", "AssertionError: assert 0.5 < 0.5"),
        ("test_wrong_key", '["valeu"]', "there is no key 'valeu' in pwm[0]"),
        ("test_wrong_top_key", '["pmw"]', "there is no key 'pmw' in hal_data"),
        ("test_run_twice", "# again", "run_test(): the robot has run already in this test, at tests/test_troubles.py:"),
        ("test_nothing_to_run", "control.run_test()", "run_test() needs a function to call on each step"),
        ("test_practice_match_too_late", "set_practice_match()", "must be called before run_test()"),
        ("test_too_long", "lambda tm: True", "the robot ran for more than 5 s of robot time, the limit"),
    ],
)
def test_what_is_wrong_in_a_test_names_the_tests_line_first(
    report: Result, troubled: RobotProject, test: str, line: str, text: str
) -> None:
    block = report.blocks()[test]
    place = troubled.place("tests/test_troubles.py", line)
    assert first_line(block).startswith(f"{place}: ")
    assert text in first_line(block)


def test_a_wrong_key_of_hal_data_is_told_with_the_nearest_and_all_there_are(report: Result) -> None:
    block = report.blocks()["test_wrong_key"]
    assert "did you mean 'value'?" in block
    assert "raw_value" in block


@for_each(
    "trouble, begin, end, who",
    [
        ("loops_forever", "# forever", "# and ever", "the robot code"),
        ("loops_forever_whatever_happens", "# whatever happens", "# it goes on", "the robot code"),
        ("loops_in_a_thread", "# in the thread", "# on and on", "a thread of the robot"),
    ],
)
def test_an_endless_loop_is_ended_and_named(
    report: Result, troubled: RobotProject, trouble: str, begin: str, end: str, who: str
) -> None:
    block = report.blocks()[f"test_teleop[{trouble}]"]
    number = number_in(first_line(block), "robot.py")
    assert troubled.line("robot.py", begin) <= number <= troubled.line("robot.py", end)
    assert f"{who} hangs here: robot time has stood at 0.02 s through 0.25 s of computing." in first_line(block)
    assert "Is it an endless loop?" in block


@for_each(
    "trouble, line, what, said",
    [
        ("leaves", "os._exit(3)", "ended itself with exit code 3", "said before leaving"),
        ("segfaults", "ctypes.string_at(0)", FAULT, "said before the fault"),
    ],
)
def test_a_robot_that_takes_its_process_down_fails_its_own_test_only(
    report: Result, troubled: RobotProject, trouble: str, line: str, what: str, said: str
) -> None:
    block = report.blocks()[f"test_teleop[{trouble}]"]
    assert first_line(block).startswith(f"{troubled.place('robot.py', line)}: ")
    assert what in first_line(block)
    assert said in block


def test_a_thread_that_will_not_stop_is_named_with_its_line(report: Result, troubled: RobotProject) -> None:
    block = report.blocks()["ERROR at teardown of test_teleop[will_not_stop]"]
    number = number_in(first_line(block), "robot.py")
    assert troubled.line("robot.py", "# stubborn") <= number <= troubled.line("robot.py", "# not to be told")
    assert "is still running after the test was over" in block
    assert "stubborn" in first_line(block)


def test_failures_show_the_users_code_and_none_of_pyfrcs(report: Result) -> None:
    showing = [name for name, block in report.blocks().items() if re.search(r"pyfrc_core[/\\]", block)]
    assert showing == []


def test_every_failure_tells_the_random_seed(report: Result) -> None:
    without = [name for name, block in report.blocks().items() if "random seed: 0 (--seed 0 repeats it)" not in block]
    assert without == []


def test_the_summary_names_the_lines(report: Result, troubled: RobotProject) -> None:
    place = troubled.place("robot.py", "return 1 / number")
    summary = report.stdout.rpartition("short test summary info")[2]
    assert f"FAILED tests/test_troubles.py::test_teleop[divides_by_zero] - {place}: ZeroDivisionError" in summary


def test_nothing_temporary_is_left_behind(report: Result, troubled: RobotProject) -> None:
    assert [path.name for path in troubled.temporary.iterdir() if not path.name.startswith("pytest-of-")] == []


# -- more of that, each with a robot of its own ---------------------------------------------------------------------

ANY_TEST = """
    def test_teleop(control):
        control.set_operator_control(enabled=True)
        control.run_test(lambda tm: tm < 1)
"""


def test_a_forgotten_super_init_names_the_constructor(make_project: MakeProject) -> None:
    robot = """
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def __init__(self):
                self.motor = wpilib.PWMSparkMax(0)
    """
    project = make_project({"robot.py": robot, "tests/test_a.py": ANY_TEST})
    result = project.run("test")
    assert result.code == 1, result.output
    block = result.blocks()["ERROR at setup of test_teleop"]
    place = project.place("robot.py", "def __init__(self)")
    assert first_line(block) == f"{place}: MyRobot.__init__ does not call super().__init__()"
    assert "Make that its first line." in block


def test_a_robot_whose_own_loop_returns_early_fails(make_project: MakeProject) -> None:
    robot = """
        import wpilib


        class MyRobot(wpilib.RobotBase):
            def startCompetition(self):
                wpilib.wait(0.5)

            def endCompetition(self):
                pass
    """
    project = make_project({"robot.py": robot, "tests/test_a.py": ANY_TEST})
    result = project.run("test")
    assert result.code == 1, result.output
    line = first_line(result.blocks()["test_teleop"])
    assert line.startswith(f"{project.place('tests/test_a.py', 'control.run_test(')}: ")
    assert "the robot program ended by itself: startCompetition() returned at 0.5" in line


HANGS = """
    import re, threading
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            threading.Thread(target=self.work, daemon=True).start()

        def work(self):
            try:
                wpilib.wait(1000)
            finally:
                while True:  # never ends
                    pass  # its work

        def autonomousPeriodic():  # no self
            pass

        def teleopPeriodic(self):
            re.match(r"(a+)+$", "a" * 60 + "b")
"""


@pytest.mark.slow
def test_hangs_that_no_python_code_can_end_are_named_too(make_project: MakeProject) -> None:
    """A call into C that never gives Python back; a thread that hangs while it is being stopped."""
    project = make_project(
        {
            "robot.py": HANGS,
            "pyproject.toml": "[tool.pyfrc.test]\nhang_seconds = 0.2\n",
            "tests/test_it.py": """
            def test_keeps_python(control, robot):
                control.set_operator_control()
                control.run_test(lambda tm: tm < 1)

            def test_hangs_at_the_end(control, robot):
                control.run_test(lambda tm: tm < 1)

            def test_without_self(control, robot):
                control.set_autonomous()
                control.run_test(lambda tm: tm < 1)
            """,
        }
    )
    result = project.run("test")
    assert result.code == 1, result.output
    blocks = result.blocks()
    first = first_line(blocks["test_keeps_python"])
    assert first.startswith(f"{project.place('robot.py', 're.match')}: the robot code hangs here")
    number = number_in(first_line(blocks["test_hangs_at_the_end"]), "robot.py")
    assert project.line("robot.py", "# never ends") <= number <= project.line("robot.py", "# its work")
    without_self, name = first_line(blocks["test_without_self"]), spelled("autonomousPeriodic")
    assert without_self.startswith(f"{project.place('robot.py', '# no self')}: the method {name}() has no ")


# -- chance ---------------------------------------------------------------------------------------------------------

ROBOT_THAT_DRAWS = """
    import random

    import numpy
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.drawn = random.random(), float(numpy.random.random())
"""

TESTS_THAT_DRAW = """
    import random

    import numpy


    def test_robot(robot):
        print("drew", *robot.drawn, random.random())
        assert False


    def test_without_robot():
        print("drew", random.random(), numpy.random.random())
        assert False
"""


def test_a_seed_repeats_what_robot_and_tests_draw(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT_THAT_DRAWS, "tests/test_drawing.py": TESTS_THAT_DRAW})
    seven, again = (project.run("test", "--seed", "7") for _ in range(2))
    assert seven.stdout.count("random seed: 7 (--seed 7 repeats it)") == 2
    drawn = re.findall(r"^drew .+$", seven.stdout, re.MULTILINE)
    assert len(drawn) == 2
    assert re.findall(r"^drew .+$", again.stdout, re.MULTILINE) == drawn
