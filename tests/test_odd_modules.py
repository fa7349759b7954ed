"""Odd objects among the modules of a robot: asking them for their file can raise an error, or make a device."""

from __future__ import annotations

from conftest import MakeProject

ROBOT = """
    import sys
    import types
    from pathlib import Path

    import commands2
    import wpilib

    odd = [types.ModuleType(f"odd{number}") for number in range(5)]
    sys.modules |= {module.__name__: module for module in odd}
    __file__ = Path(__file__)
    odd[0].__file__ = Path(__file__)
    odd[1].__file__ = ""
    odd[2].__file__ = "a\\0b"
    odd[3].__getattr__ = lambda name: wpilib.PWMSparkMax(3)
    makes = {"__getattr__": lambda self, name: wpilib.PWMSparkMax(3)}
    odd[4].__class__ = type("Lazy", (types.ModuleType,), makes)

    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            wpilib.PWMSparkMax(3)
"""

SHORT = "[tool.pyfrc.fuzz]\nmatch_seconds = 1\n"


def test_odd_modules_are_left_alone(make_project: MakeProject) -> None:
    """To ask one for its file can raise an error, or make a device before the fork."""
    project = make_project({"robot.py": ROBOT, "pyproject.toml": SHORT})
    found = project.run("fuzz", "--seed", "1", "--runs", "1")
    assert (found.code, "Nothing was found." in found.stdout) == (0, True), found.output
