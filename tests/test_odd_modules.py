"""Odd objects among the modules of a robot: asking them for their file can raise an error, or make a device."""

from __future__ import annotations

import pytest
from conftest import MakeProject, sampled

ROBOT = """
    import sys
    import types
    from pathlib import Path

    import commands2
    import wpilib

    odd = types.ModuleType("odd")
    sys.modules["odd"] = odd
    {}

    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            {}
"""

SHORT = "[tool.pyfrc.fuzz]\nmatch_seconds = 1\n"


@pytest.mark.parametrize(
    "oddity",
    sampled(
        [
            "odd.__file__ = Path(__file__)",
            "odd.__file__ = ''",
            "odd.__file__ = 'a\\0b'",
            "__file__ = Path(__file__)",
            "odd.__getattr__ = lambda name: wpilib.PWMSparkMax(3)",
            "makes = {'__getattr__': lambda self, name: wpilib.PWMSparkMax(3)};"
            " odd.__class__ = type('Lazy', (types.ModuleType,), makes)",
        ],
        "odd.__getattr__ = lambda name: wpilib.PWMSparkMax(3)",
    ),
)
def test_odd_modules_are_left_alone(oddity: str, make_project: MakeProject) -> None:
    """To ask one for its file can raise an error, or make a device before the fork."""
    robot = ROBOT.format(oddity, "wpilib.PWMSparkMax(3)")
    project = make_project({"robot.py": robot, "pyproject.toml": SHORT})
    found = project.run("fuzz", "--seed", "1", "--runs", "1")
    assert (found.code, "Nothing was found." in found.stdout) == (0, True), found.output
