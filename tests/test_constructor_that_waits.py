"""A robot whose constructor waits after `super().__init__()`, as for a sensor that starts."""

from __future__ import annotations

from conftest import MakeProject


def test_time_goes_on_in_the_constructor(make_project: MakeProject) -> None:
    robot = """
        import time

        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def __init__(self):
                super().__init__()
                wpilib.wait(1)
                time.sleep(0.5)
                self.constructed = wpilib.Timer.getFPGATimestamp()
    """
    test = """
        def test_robot(control, robot):
            assert robot.constructed == 1.5
            with control.run_robot():
                control.step_timing(seconds=1, autonomous=False, enabled=True)
    """
    result = make_project({"robot.py": robot, "tests/test_robot.py": test}).run("test")
    assert result.code == 0, result.output
