"""A robot with a bug in each of its opmodes: tests name the line, fuzz finds and shrinks each, a replay repeats it."""

from __future__ import annotations

import re

import pytest
from conftest import MakeProject, RobotProject

ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            self.motor = wpilib_drivers.PWMSparkMax(0)
            self.limit = wpilib.DigitalInput(2)
            self.pad = wpilib.Gamepad(0)


    @wpilib.autonomous(name="Leave the line")
    class Leave(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot, self.timer, self.samples = robot, wpilib.Timer(), []
            self.add_periodic(self.sample, 0.005)

        def start(self):
            self.timer.restart()

        def sample(self):
            self.samples.append(self.timer.get())
            if len(self.samples) > 300:
                self.samples[1000]  # in a timed callback, after 1.5 s

        def periodic(self):
            self.robot.motor.set_throttle(0.5)


    @wpilib.teleop
    class Drive(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot = robot

        def periodic(self):
            self.robot.motor.set_throttle(-self.robot.pad.get_left_y())
            if self.robot.pad.get_left_bumper_button() and not self.robot.limit.get():
                self.robot.motor.set_throttle("up")  # only with two inputs

        def end(self):
            self.robot.motor.set_throttle(0)


    @wpilib.utility
    class Calibrate(wpilib.OpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot, self.low = robot, None

        def periodic(self):
            if self.robot.pad.get_face_down_button_pressed():
                self.low = 1.0

        def end(self):
            print(5 - self.low)  # if nothing was pressed
"""
BUGS = ("self.samples[1000]", 'set_throttle("up")', "print(5 - self.low)")


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    return make_project({"robot.py": ROBOT, "tests/test_robot.py": "from pyfrc.tests import test_opmode\n"})


def test_tests_name_the_line(project: RobotProject) -> None:
    result = project.run("test")
    places = [project.place("robot.py", bug) for bug in BUGS]
    assert [bool(re.search(rf"^{place}: \w+", result.stdout, re.MULTILINE)) for place in places] == [True, False, True]


@pytest.mark.slow
def test_fuzz_finds_each_and_replays_repeat_it(project: RobotProject) -> None:
    result = project.run("fuzz", "--runs", "60", "--seed", "1", "-j", "1")
    scripts = list((project.path / "tests" / "fuzz").glob("*.jsonl"))
    found = {each: each.read_text("utf-8") for each in scripts}
    for bug in BUGS:
        place = project.place("robot.py", bug)
        (script,) = [each for each, text in found.items() if f"{place}:" in text.splitlines()[0]]
        assert len(found[script].splitlines()) <= 4, found[script]
        replayed = [project.run("replay", f"tests/fuzz/{script.name}") for _ in range(2)]
        assert {(each.code, each.stdout.splitlines()[-1]) for each in replayed} == {
            (1, replayed[0].stdout.splitlines()[-1])
        }
        assert f"{place}: " in replayed[0].output, result.output
