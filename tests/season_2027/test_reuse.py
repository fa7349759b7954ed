"""An `OpModeRobot` with an IMU comes out of its run as good as new: the next one is as in a fork."""

from __future__ import annotations

import re

from conftest import MakeProject

ROBOT = """
    import wpilib
    import wpilib_drivers
    from hal import RobotMode


    class Drive(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot = robot

        def periodic(self):
            self.robot.motor.set_throttle(0.4)


    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            self.motor = wpilib_drivers.PWMSparkMax(1)
            self.imu = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)
            self.add_opmode(Drive, RobotMode.TELEOPERATED, "Drive")
            self.publish_opmodes()
"""

TEST = """
    import pytest


    @pytest.mark.parametrize("run", [1, 2])
    def test_drive(control, hal_data, run):
        with control.run_robot():
            control.step_timing(seconds=0.2, opmode="Drive", enabled=True)
            assert hal_data["onboard_imu"]["yaw"] == 0.0
            hal_data["onboard_imu"]["yaw"] = 1.5
            control.step_timing(seconds=0.2, opmode="Drive", enabled=True)
"""


READY_MADE = """
    from pyfrc.tests import *
"""


def test_only_one_process_asks_the_robot_for_its_opmodes(make_project: MakeProject) -> None:
    counts = ROBOT.replace("self.publish_opmodes()", "self.publish_opmodes()\n            open('made', 'a').write('x')")
    project = make_project({"robot.py": counts, "tests/test_robot.py": READY_MADE})
    result = project.run("test", "--isolation", "reuse", "--", "-k", "test_opmode or test_disabled")
    assert result.code == 0, result.output
    assert len((project.path / "made").read_text("utf-8")) == 3  # to be asked, and in two tests


def test_one_interpreter_runs_all_tests(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_drive.py": TEST})
    found = []
    for isolation in ("fork", "reuse"):
        result = project.run("test", "-j", "1", "--trace", isolation, "--isolation", isolation, "--", "-v")
        assert result.code == 0, result.output
        assert re.findall("pyfrc: .*", result.output) == []
        found += [file.read_text().splitlines()[-1] for file in (project.path / isolation).iterdir()]
    assert len(found) == 4
    assert len(set(found)) == 1
