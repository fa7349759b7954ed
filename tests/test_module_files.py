"""commands2 asks for the files of modules when commands are composed: they are known before tests and matches fork."""

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

RESOLVED = "import inspect; assert commands2.__file__ in inspect.modulesbyfile"
TEST = "def test_it(control, robot):\n    control.run_test(lambda now: now < 0.1)\n"
SHORT = "[tool.pyfrc.fuzz]\nmatch_seconds = 1\n"


@pytest.mark.parametrize("command", sampled(["test", "fuzz --seed 1 --runs 1"], "test"))
def test_they_are_known(command: str, make_project: MakeProject) -> None:
    files = {"robot.py": ROBOT.format("", RESOLVED), "tests/test_it.py": TEST, "pyproject.toml": SHORT}
    result = make_project(files).run(*command.split(), cold=True)
    assert result.code == 0, result.output


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
        "odd.__file__ = Path(__file__)",
        "odd.__getattr__ = lambda name: wpilib.PWMSparkMax(3)",
    ),
)
def test_odd_modules_are_left_alone(oddity: str, make_project: MakeProject) -> None:
    """To ask one for its file can raise an error, or make a device before the fork."""
    robot = ROBOT.format(oddity, "wpilib.PWMSparkMax(3)")
    project = make_project({"robot.py": robot, "pyproject.toml": SHORT})
    found = project.run("fuzz", "--seed", "1", "--runs", "1")
    assert (found.code, "Nothing was found." in found.stdout) == (0, True), found.output
