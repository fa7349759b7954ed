"""Letters that a terminal or a file does not have end no command, and hide no error of the robot's."""

from __future__ import annotations

import pytest
from conftest import MakeProject

ROBOT = r"""
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def teleopPeriodic(self):
            raise RuntimeError("no file \udcff.json, \u2192")
"""


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252"])
def test_the_error_of_a_simulated_robot(encoding: str, make_project: MakeProject) -> None:
    """A name that is no UTF-8, from `os.listdir`, has such a letter; and pipes on Windows know few of them."""
    project = make_project({"robot.py": ROBOT})
    result = project.run(
        *("sim", "--ui", "none", "--mode", "teleop", "--seconds", "1"), env={"PYTHONIOENCODING": encoding}
    )
    assert result.code == 1, result.output
    assert r"robot.py:6: RuntimeError: no file \udcff.json" in result.stdout, result.output
    assert "UnicodeEncodeError" not in result.output
