"""Exceptions without a line of the robot's own: which calls of libraries led there."""

from __future__ import annotations

import re
from typing import Any

import pytest

ROBOT = """
    import operator
    from functools import partial

    import commands2
    from commands2.button import CommandXboxController

    class Divide(commands2.RunCommand):
        pass

    class DivideAgain(commands2.RunCommand):
        pass

    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.gamepad = CommandXboxController(0)
            fails = partial(operator.truediv, 1, 0)
            self.gamepad.a().onTrue(Divide(fails))
            self.gamepad.b().onTrue(DivideAgain(fails))
    """


@pytest.mark.slow
def test_exceptions_in_libraries_show_the_calls_and_differ_by_them(make_project: Any) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 5\n"})
    result = project.run("fuzz", "--seed", "1", "--runs", "16")
    assert result.code == 1
    found = re.findall(r"^robot.py:\d+: (ZeroDivisionError: .*)", result.stdout, re.MULTILINE)
    wanted = "ZeroDivisionError: division by zero (in {}.execute, called by CommandScheduler.run)"
    assert sorted(found) == [
        wanted.format("Divide"),
        wanted.format("DivideAgain"),
    ], result.output
    files = sorted((project.path / "tests/fuzz").glob("*.jsonl"))
    assert [file.name for file in files] == [
        "zerodivisionerror-divide_execute.jsonl",
        "zerodivisionerror-divideagain_execute.jsonl",
    ]
    replayed = project.run("replay", files[0])
    assert ": ZeroDivisionError: division by zero (in Divide.execute, called by" in replayed.output
