"""A library that makes a notifier when it is imported keeps no robot's tests from being forked.

The stand-in for `urcl` does as `urcl` does: with its import, the HAL has a notifier, and the process a thread for it.
"""

from __future__ import annotations

import sys

import pytest
from conftest import MakeProject, RobotProject

pytestmark = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="tests are not forked here")

LIBRARY = """
    import os
    import threading

    import hal

    notifier = hal.initializeNotifier()[0]
    thread = threading.Thread(target=hal.waitForNotifierAlarm, args=(notifier,), daemon=True)
    thread.start()
    imported_in = os.getpid()
    started = []


    class URCL:
        @staticmethod
        def start(*args):
            assert thread.is_alive()
            started.append(args)
"""

ROBOT = """
    import os

    import urcl
    import wpilib
    from urcl import URCL

    imported_in = os.getpid()


    class MyRobot(wpilib.TimedRobot):
        logger = URCL

        def robotInit(self):
            urcl.URCL.start({1: "left"})
            URCL.start()
            self.logger.start()
"""

#: As teams write them: a test file imports the robot's modules, too.
TESTS = """
    import os

    import pytest
    import robot as program


    @pytest.mark.parametrize("number", (1, 2))
    def test_forked(control, robot, number):
        control.run_test(lambda tm: tm < 1)
        assert program.urcl.imported_in == os.getpid()
        assert program.urcl.started == [({1: "left"},), (), ()]
        assert program.imported_in == os.getppid()
"""


def run(project: RobotProject, library: str | None, *options: str) -> tuple[list[str], dict[str, str], str]:
    """Run the project's tests with the library at hand; return what pyfrc explains, the outcomes, and the output."""
    others = project.path.parent / "others"
    others.mkdir(exist_ok=True)
    if library is not None:
        RobotProject(others, others).write({"urcl/__init__.py": library})
    result = project.run("test", *options, "--", "-v", env={"PYTHONPATH": str(others)})
    outcomes = {name.rpartition("::")[2]: outcome for name, outcome in result.outcomes().items()}
    return [line for line in result.output.splitlines() if line.startswith("pyfrc: ")], outcomes, result.output


def test_the_robot_is_imported_once_and_the_library_in_each_fork(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": TESTS})
    explained, outcomes, output = run(project, LIBRARY)
    assert outcomes == {"test_forked[1]": "PASSED", "test_forked[2]": "PASSED"}, output
    assert explained == []


def test_without_isolation_the_library_is_imported_too(make_project: MakeProject) -> None:
    tests = TESTS.replace("assert program.imported_in == os.getppid()", "").replace("(1, 2)", "(1,)")
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": tests})
    _, outcomes, output = run(project, LIBRARY, "--no-isolation")
    assert outcomes == {"test_forked[1]": "PASSED"}, output


def test_a_use_while_the_robot_is_imported_works_as_before(make_project: MakeProject) -> None:
    robot = ROBOT.replace("    imported_in = os.getpid()", "    URCL.start()\n    imported_in = os.getpid()")
    project = make_project(
        {"robot.py": robot, "tests/test_a.py": "    def test_it(control):\n        control.run_test(lambda tm: tm < 1)"}
    )
    explained, outcomes, output = run(project, LIBRARY)
    assert outcomes == {"test_it": "PASSED"}, output
    assert "devices are made: a notifier" in explained[0]


def test_a_robot_that_derives_from_a_class_of_the_library_works(make_project: MakeProject) -> None:
    robot = ROBOT.replace("    class MyRobot", "    class Logger(URCL):\n        pass\n\n\n    class MyRobot")
    tests = "    import robot\n\n\n    def test_it(control):\n        assert isinstance(robot.Logger(), robot.URCL)"
    project = make_project({"robot.py": robot, "tests/test_a.py": tests})
    _, outcomes, output = run(project, LIBRARY)
    assert outcomes == {"test_it": "PASSED"}, output


def test_a_submodule_of_the_library_can_be_imported(make_project: MakeProject) -> None:
    robot = ROBOT.replace("    import urcl\n", "    import urcl\n    import urcl.version\n")
    tests = "    import robot\n\n\n    def test_it(control):\n        assert robot.urcl.version.NUMBER == 7"
    project = make_project({"robot.py": robot, "tests/test_a.py": tests})
    RobotProject(project.path.parent / "others", project.path).write({"urcl/version.py": "    NUMBER = 7"})
    _, outcomes, output = run(project, LIBRARY)
    assert outcomes == {"test_it": "PASSED"}, output


def test_a_missing_library_is_reported_when_the_robot_is_imported(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT.replace("urcl", "urcl_2"), "tests/test_a.py": TESTS})
    *_, output = run(project, None)
    assert "robot.py:3" in output
    assert "there is no module urcl_2" in output


def test_a_library_that_fails_is_reported_with_the_line_that_imports_it(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": TESTS})
    _, outcomes, output = run(project, "    raise ImportError('built for another wpilib')")
    assert set(outcomes.values()) == {"ERROR"}, output
    assert "robot.py:3: ImportError: built for another wpilib" in output


def test_a_name_that_the_library_lacks_is_reported_with_the_line_that_uses_it(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT.replace("urcl.URCL", "urcl.Urcl"), "tests/test_a.py": TESTS})
    *_, output = run(project, LIBRARY)
    assert "robot.py:14" in output
    assert "AttributeError: module 'urcl' has no attribute 'Urcl'" in output
