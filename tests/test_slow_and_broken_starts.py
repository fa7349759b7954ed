"""Robots whose `robotInit` takes long, and robots that end their process while they are imported or started."""

from __future__ import annotations

import pytest
from conftest import MakeProject

SLOW = """
    import time

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            time.sleep(7)
"""


def test_the_ready_made_tests_wait_for_robot_init(make_project: MakeProject) -> None:
    result = make_project({"robot.py": SLOW}).run("test", "--builtin")
    assert result.code == 0, result.output


def test_a_test_that_ends_before_robot_init_is_explained(make_project: MakeProject) -> None:
    test = """
        def test_robot(control, robot):
            control.set_operator_control()
            control.run_test(lambda now: now < 1)


        def test_two(control, robot):
            control.run_test(lambda now: control.robot_is_starting or now < 8)
            assert not control.robot_is_starting
    """
    result = make_project({"robot.py": SLOW, "tests/test_robot.py": test}).run("test")
    assert result.code == 1
    assert "1 failed, 1 passed" in result.output, result.output
    assert "the test ended at 1.00 s of robot time, while robotInit still waited" in result.blocks()["test_robot"]


@pytest.mark.parametrize("status", [0, 3])
def test_an_exit_while_the_robot_is_imported_is_a_failure_with_its_line(make_project: MakeProject, status: int) -> None:
    project = make_project({"robot.py": f"import os\n\nos._exit({status})\n"})
    result = project.run("test", "--builtin")
    assert result.code == (status or 1)
    assert f"robot.py:3: os._exit({status}) was called while the robot's code was imported" in result.output


def test_a_fault_while_the_robot_is_imported_prints_the_line(make_project: MakeProject) -> None:
    project = make_project({"robot.py": "import os\nimport signal\n\nos.kill(os.getpid(), signal.SIGSEGV)\n"})
    result = project.run("test", "--builtin")
    assert result.code not in (0, 2)
    assert 'robot.py", line 4' in result.output


def test_a_robot_that_dies_in_robot_init_dies_disabled(make_project: MakeProject) -> None:
    robot = SLOW.replace("time.sleep(7)", "__import__('os')._exit(3)")
    result = make_project({"robot.py": robot}).run("test", "--builtin", "--", "-k", "operator")
    assert "in disabled mode" in result.output, result.output
