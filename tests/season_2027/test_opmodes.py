"""An `OpModeRobot` in place: opmodes are made, started, called and ended as on a robot, and chosen by tests."""

from __future__ import annotations

import re

import pytest
from conftest import MakeProject

ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            self.motor, self.stick = wpilib_drivers.PWMSparkMax(1), wpilib.Joystick(0)
            self.log, self.slow, self.fast = [], 0, []
            self.add_periodic(self.on_slow, 0.1)

        def on_slow(self):
            self.slow += 1


    @wpilib.autonomous
    class Forward(wpilib.PeriodicOpMode):
        def __init__(self, robot: MyRobot):
            super().__init__()
            self.robot = robot
            robot.log.append("made")
            self.add_periodic(self.on_fast, 0.005)

        def on_fast(self):
            self.robot.fast.append(wpilib.Timer.get_timestamp())

        def start(self):
            self.robot.log.append("start")

        def periodic(self):
            self.robot.motor.set_throttle(0.25)

        def end(self):
            self.robot.log.append("end")


    @wpilib.teleop
    class Drive(wpilib.PeriodicOpMode):
        def __init__(self, robot: MyRobot):
            super().__init__()
            self.robot = robot

        def periodic(self):
            self.robot.motor.set_throttle(-self.robot.stick.get_y())
"""


def test_the_life_of_an_opmode(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_robot.py": """
                from pytest import raises

                from pyfrc.tests import *


                def test_life(control, hal_data, robot):
                    with control.run_robot():
                        control.step_timing(seconds=0.1, opmode="Forward", enabled=False)
                        assert robot.log == ["made"]
                        assert len(robot.fast) == 15  # while disabled, too
                        control.step_timing(seconds=0.2, opmode="Forward", enabled=True)
                        assert (robot.log, robot.slow) == (["made", "start"], 3)
                        assert hal_data["pwm"][1]["value"] == 0.25
                        hal_data["joysticks"][0]["axes"][1] = -0.75
                        control.step_timing(seconds=0.1, opmode="Drive", enabled=True)
                        assert robot.log == ["made", "start", "end"]
                        assert hal_data["pwm"][1]["value"] == 0.75
                        calls = len(robot.fast)
                        control.step_timing(seconds=0.1, opmode="Drive", enabled=True)
                        assert len(robot.fast) == calls


                def test_what_there_is_not(control, robot):
                    with control.run_robot():
                        with raises(Exception, match="no opmode 'Back': the robot has published .*'Forward'"):
                            control.set_opmode("Back")
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output


def test_a_test_runs_once_for_each_opmode_and_names_the_line_that_fails(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT.replace("-self.robot.stick.get_y()", "1 / 0"),
            "tests/test_robot.py": "from pyfrc.tests import test_opmode\n",
        }
    )
    result = project.run("test", "--", "-v")
    assert result.code == 1
    assert "test_opmode[autonomous-Forward] PASSED" in result.stdout, result.output
    assert "test_opmode[teleop-Drive] FAILED" in result.stdout
    assert re.search(r"robot\.py:\d+: ZeroDivisionError", result.stdout)


@pytest.mark.parametrize(
    "line",
    [
        'robot.log.append("made")',
        'self.robot.log.append("start")',
        "self.robot.fast.append(wpilib.Timer.get_timestamp())",
    ],
)
def test_an_error_in_an_opmode_is_the_robots(line: str, make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT.replace(line, "undefined_name"),
            "tests/test_robot.py": "from pyfrc.tests import test_opmode\n",
        }
    )
    result = project.run("test")
    assert result.code == 1
    assert re.search(r"robot\.py:\d+: NameError", result.stdout), result.output


def test_a_robot_without_opmodes_skips_it(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n",
            "tests/test_robot.py": "from pyfrc.tests import test_disabled, test_opmode\n",
        }
    )
    assert "1 passed, 1 skipped" in project.run("test").stdout


def test_a_recording_has_the_opmodes_and_its_replay_is_the_same(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_robot.py": """
                def test_two(control, hal_data, robot):
                    with control.run_robot():
                        control.step_timing(seconds=0.2, opmode="Forward", enabled=True)
                        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
                        hal_data["control"]["opmode"] = "Drive"
                        hal_data["joysticks"][0]["axes"][1] = -0.75
                        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
                        assert hal_data["pwm"][1]["value"] == 0.75
                        control.set_autonomous()  # of each mode, the opmode that was chosen for it
                        assert hal_data["control"]["opmode"] == "Forward"
            """,
        }
    )
    assert project.run("test", "--record", "recorded").code == 0
    (script,) = (each for each in (project.path / "recorded").glob("*.jsonl") if "trace" not in each.name)
    assert script.read_text("utf-8").count("control.opmode") == 4  # Forward, none yet in teleop, Drive, Forward
    result = project.run("replay", f"recorded/{script.name}")
    assert "The trace equals the recorded one." in result.stdout, result.output


@pytest.mark.slow
def test_fuzz_selects_opmodes_and_finds_what_fails_in_one(make_project: MakeProject) -> None:
    project = make_project(
        {"robot.py": ROBOT.replace("-self.robot.stick.get_y()", "1 / (self.robot.stick.get_y() - 1)")}
    )
    result = project.run("fuzz", "--runs", "25", "--seed", "1", "-j", "1")
    assert re.search(r"robot\.py:\d+: ZeroDivisionError", result.output), result.output
    (script,) = (project.path / "tests" / "fuzz").glob("*.jsonl")
    assert '"control.opmode": "Drive"' in script.read_text("utf-8")
    assert "ZeroDivisionError" in project.run("replay", f"tests/fuzz/{script.name}").output
