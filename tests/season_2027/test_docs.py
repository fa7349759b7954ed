"""The examples of the documentation that are for WPILib 2027."""

from __future__ import annotations

import re
from pathlib import Path

from conftest import MakeProject

TESTING = Path(__file__).parents[2] / "docs" / "testing.md"
ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            self.motor = wpilib_drivers.PWMSparkMax(0)


    class Goes(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.motor, self.timer = robot.motor, wpilib.Timer()

        def start(self):
            self.timer.restart()

        def periodic(self):
            self.motor.set_throttle(0.5 if self.timer.get() < 2 else 0)


    @wpilib.autonomous(name="Leave the line")
    class Leave(Goes):
        pass


    @wpilib.autonomous
    class Score(Goes):
        pass


    @wpilib.teleop
    class Drive(wpilib.PeriodicOpMode):
        pass
"""


def test_opmodes_in_tests(make_project: MakeProject) -> None:
    (example,) = re.findall(r"^```py\n(import pytest.*?)^```$", TESTING.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    result = make_project({"robot.py": ROBOT, "tests/test_it.py": example}).run("test", "--", "-v")
    assert result.code == 0, result.output
    assert result.stdout.count("PASSED") == 1 + 3 + 2
