"""The examples of the documentation that are for WPILib 2027."""

from __future__ import annotations

import re
from pathlib import Path

from conftest import MakeProject

DOCS = Path(__file__).parents[2] / "docs"
TESTING = DOCS / "how_to/use_opmodes.md"
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


PAGE = (DOCS / "reference/wpilib_2027.md").read_text("utf-8")

MODES = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.made, self.utility = wpilib.Timer.get_timestamp(), 0

        def utility_periodic(self):
            self.utility += 1
"""


def test_the_keys_that_are_gone_and_new(make_project: MakeProject) -> None:
    rows = re.findall(r"^\| (`.*) \| (gone|new|`).*\|$", PAGE.partition("| key |")[2], re.MULTILINE)
    keys = {path: kind == "new" for names, kind in rows for path in re.findall(r"`([^`]+)`", names)}
    assert len(keys) > 15
    test = """
        import pytest


        @pytest.mark.parametrize(("path", "there"), KEYS)
        def test_key(path, there, hal_data):
            try:
                hal_data.read(path)
            except (KeyError, IndexError):
                assert not there
            else:
                assert there
    """.replace("KEYS", repr(list(keys.items())))
    result = make_project({"robot.py": MODES, "tests/test_keys.py": test}).run("test")
    assert result.code == 0, result.output


def test_test_mode_and_time(make_project: MakeProject) -> None:
    test = """
        def test_it(control, robot, fake_time):
            assert fake_time.get() == 0
            control.set_test_mode(enabled=True)
            control.run_test(lambda tm: tm < 1)
            assert robot.utility == 49
            assert robot.made % 1e6 == 0 and robot.made >= 1e6
    """
    result = make_project({"robot.py": MODES, "tests/test_it.py": test}).run("test")
    assert result.code == 0, result.output
