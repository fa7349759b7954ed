"""Commands show what the robot prints, and nothing that libraries print about themselves."""

from __future__ import annotations

import os
import sys
from collections.abc import Container

import pytest
from conftest import MakeProject, RobotProject, sampled

needs_fork = pytest.mark.skipif(not hasattr(os, "fork") or sys.platform == "darwin", reason="there is no safe fork")

#: Prints as a vendor's library does, from C; has no `autonomousPeriodic`.
ROBOT = """
    import os
    import sys

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            os.write(1, b"[phoenix] CANbus Connected: sim\\n[phoenix] Library initialization is complete.\\n\\t\\n")
            os.write(2, b"NavX: Connected.\\n")
            os.write(2, b"NavX: the robot's own error\\n")
            print("the robot's own line", flush=True)

        def disabledPeriodic(self):
            pass
"""
TESTS = """
    import pytest


    @pytest.mark.parametrize("number", range(3))
    def test_it(control, number):
        control.set_autonomous(enabled=True)
        control.run_test(lambda tm: tm < 0.1)
        assert number == 0, f"it is {number}"
"""
ONCE = "Default AutonomousPeriodic() method... Override me!"
ROBOT_PERIODIC = "Default RobotPeriodic() method... Override me!"


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    return make_project({"robot.py": ROBOT, "tests/test_it.py": TESTS})


def check(output: str, times: int, defaults: Container[int] = (1,)) -> None:
    """Check what is shown of several runs of the robot.

    :param defaults: how often it is shown that methods are not overridden, which WPILib prints once in a process
    """
    lines = output.splitlines()
    assert sum(line.endswith("the robot's own line") for line in lines) == times
    assert sum(line.endswith("NavX: the robot's own error") for line in lines) == times
    assert all(lines.count(line) in defaults for line in (ONCE, ROBOT_PERIODIC))
    for hidden in ("CameraServerShared", "SimulationPeriodic", "[phoenix]", "NavX: Connected", "\t"):
        assert hidden not in output


@pytest.mark.parametrize(
    "isolation", [pytest.param("fork", marks=needs_fork), pytest.param("reuse", marks=pytest.mark.slow)]
)
def test_of_the_output_of_tests_that_failed(project: RobotProject, isolation: str) -> None:
    # What an interpreter prints once is in its first test: in the one that passes; or, if a second interpreter was
    # ready before the first one was as good as new, in one that fails, too.
    result = project.run("test", "--isolation", isolation, "-j", "1")
    assert "2 failed, 1 passed" in result.stdout
    check(result.output, 2, defaults=range(3) if isolation == "reuse" else (1,))


@needs_fork
@pytest.mark.parametrize("jobs", sampled(["1", "2"], "2"))
def test_of_output_that_is_not_captured(project: RobotProject, jobs: str) -> None:
    result = project.run("test", "-j", jobs, "--", "-s")
    assert "2 failed, 1 passed" in result.stdout
    check(result.output, 3)
    assert "the robot's own line" in result.stdout
    assert "the robot's own error" in result.stderr


def test_of_a_simulation(project: RobotProject) -> None:
    result = project.run("sim", "--ui", "none", "--mode", "auto", "--seconds", "1")
    assert result.code == 0
    check(result.output, 1)


@needs_fork
def test_what_a_test_prints_before_its_process_dies_is_shown(make_project: MakeProject) -> None:
    tests = """
        import os


        def test_it(robot):
            os.write(1, b"last words, NavX")
            os._exit(3)
    """
    result = make_project({"robot.py": ROBOT, "tests/test_it.py": tests}).run("test", "--", "-s")
    assert result.code == 1
    assert "last words, NavX" in result.stdout
