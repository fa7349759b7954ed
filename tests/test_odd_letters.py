"""Letters that a terminal or a file does not have end no command, and hide no error of the robot's."""

from __future__ import annotations

import pytest
from conftest import MakeProject, sampled

ROBOT = r"""
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def teleopPeriodic(self):
            raise RuntimeError("no file \udcff.json, \u2192")
"""


@pytest.mark.parametrize("encoding", sampled(["utf-8", "cp1252"], "cp1252"))
def test_the_error_of_a_simulated_robot(encoding: str, make_project: MakeProject) -> None:
    """A name that is no UTF-8, from `os.listdir`, has such a letter; and pipes on Windows know few of them."""
    project = make_project({"robot.py": ROBOT})
    result = project.run(
        *("sim", "--ui", "none", "--mode", "teleop", "--seconds", "1"), env={"PYTHONIOENCODING": encoding}
    )
    assert result.code == 1, result.output
    assert r"robot.py:6: RuntimeError: no file \udcff.json" in result.stdout, result.output
    assert "UnicodeEncodeError" not in result.output


PRINTS = r"""
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def teleopInit(self):
            print("Gr\u00f6\u00dfe \u2192 1")
"""


def test_a_robot_may_print_any_letter_in_a_new_interpreter(make_project: MakeProject) -> None:
    """Its output is a file there, which has Windows' encoding by default."""
    project = make_project({"robot.py": PRINTS})
    result = project.run(
        *("test", "--builtin", "--isolation", "reuse", "--", "-s", "-k", "operator_control"),
        env={"PYTHONIOENCODING": "ascii"},
    )
    assert result.code == 0, result.output
    assert "Gr\\xf6\\xdfe \\u2192 1\n" in result.stdout


def test_what_a_test_that_fails_before_a_deploy_says(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": PRINTS,
            "tests/test_it.py": "def test_it(robot):\n    assert 0, 'Größe → 1'\n",
        }
    )
    result = project.run("deploy", "--robot", "127.0.0.1:9", "-q", env={"PYTHONIOENCODING": "cp1252"})
    assert "AssertionError: Gr\ufffd\ufffde \\u2192 1" in result.output  # each is one byte, which is no UTF-8
