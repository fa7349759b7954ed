"""Hints about code that raises no error here: each with its line, and what to write."""

from __future__ import annotations

import ast
from pathlib import Path
from textwrap import dedent
from types import ModuleType, SimpleNamespace

import commands2
import pytest
import wpilib
from loops import for_each

from pyfrc_core.repeated_lines import RepeatedLines, shortened
from pyfrc_core.runtime.checks.code_checks import find_misspelled_settings
from pyfrc_core.runtime.checks.enum_values import find_early_reads, find_sticks_read_once, find_wrong_comparisons
from pyfrc_core.runtime.checks.kinds import Kinds
from pyfrc_core.runtime.checks.lost_commands import find_lost_commands
from pyfrc_core.runtime.checks.never_used import find_never_used, find_unmatched_keys
from pyfrc_core.runtime.checks.no_effect import find_lines_without_effect
from pyfrc_core.runtime.checks.sources import SourceFile
from pyfrc_core.runtime.checks.wrong_moments import find_wrong_moments
from pyfrc_core.runtime.checks.wrong_tests import find_wrong_tests
from pyfrc_core.runtime.checks.wrong_units import find_wrong_units


def source(text: str, is_test: bool = False) -> SourceFile:
    """Run a text as a file of the project."""
    module = ModuleType("robot")
    vars(module).update(wpilib=wpilib, commands2=commands2)
    text = dedent(text).strip() + "\n"
    exec(text, vars(module))
    return SourceFile("robot.py", ast.parse(text), module, is_test)


def hints(text: str, is_test: bool = False) -> list[str]:
    files = [source(text, is_test)]
    kinds = Kinds(files)
    found = [
        *find_lines_without_effect(kinds),
        *find_wrong_comparisons(files),
        *find_early_reads(files),
        *find_sticks_read_once(kinds),
        *find_never_used(kinds),
        *find_lost_commands(kinds),
        *find_wrong_moments(kinds),
        *find_wrong_units(kinds),
        *find_wrong_tests(kinds),
    ]
    return [f"{each.where.removeprefix('robot.py:')}: {each.text} / {each.remedy}" for each in found]


@for_each(
    "line, text, remedy",
    [
        ("self.command.schedule", "self.command.schedule does nothing", "Write self.command.schedule()"),
        ("self.state == 2", "this comparison does nothing", "self.state = ..."),
        ("self.speed + 1", "is computed, and nothing is done", "self.speed = self.speed + 1"),
        ("self.speed =+ 1", "=+ sets self.speed to +1", "Write self.speed += 1"),
        ("self.speed =- 1", "=- sets self.speed to -1", "Write self.speed -= 1"),
        ("helper", "helper does nothing: it is not called", "Write helper()"),
        ("if self.pad.getAButton: pass", "getAButton is a function, which counts as true", "self.pad.getAButton()"),
        ("if not self.at_goal and True: pass", "self.at_goal is a function", "self.at_goal()"),
        ("self.at_goal = True", "replaces the method at_goal", "Choose another name"),
        ("if self.pad.getPOV == 90: pass", "getPOV is a function", "self.pad.getPOV()"),
        ("(a and b).onTrue(c)", "and takes one of the triggers", "Write (a & b).onTrue(...)"),
        ("if self.pad.getPOV(): pass", "self.pad.getPOV() is -1 if nothing is pressed", "Write self.pad.getPOV() == 0"),
        (
            "if wpilib.DriverStation.getAlliance() == 'red': pass",
            "Alliance is never equal to the text 'red'",
            "Write wpilib.DriverStation.Alliance.kRed",
        ),
        ("if self.pad.getRawButton(0): pass", "there is no button 0: buttons are 1 to 32", "getAButton()"),
        ("commands2.button.JoystickButton(self.pad, 33)", "there is no button 33", "the button's number"),
        (
            "if self.pad.getRawButton(1) or 2: pass",
            "self.pad.getRawButton(1) or 2 is always true",
            "Write self.pad.getRawButton(1) or self.pad.getRawButton(2)",
        ),
        ("if not (self.mode == 1 or 3): pass", "is always true, since 3 counts", "self.mode == 1 or self.mode == 3"),
        ("while self.timer.get() == 2.0: pass", "is hardly ever 2.0 exactly", "Write self.timer.get() >= 2.0"),
        ("side = getAlliance()\n        if side in ('Blue', 1): pass", "the text 'Blue'", "Alliance.kBlue"),
        ("if DriverStation.getMatchType() == 3: pass", "the number 3", "kPractice"),
    ],
)
def test_a_line_that_does_not_do_what_it_says(line: str, text: str, remedy: str) -> None:
    robot = f"""
    def helper(): pass
    class Robot(commands2.TimedCommandRobot):
        def at_goal(self): return True
        def go(self, a, b, c):
            {line}
    """
    (found,) = hints(robot.replace("\n        if", "\n            if") if "\n" in line else robot)
    assert text in found
    assert remedy in found


@for_each(
    "line",
    [
        "self.speed = -1",
        "self.speed=-1",
        "self.speed = + 1",
        "'a docstring'",
        "...",
        "self.limit = 3\n            if self.limit: pass",
        "if self.pad.getAButton(): pass",
        "if self.state.position > 1: pass\n    def position(self): pass",
        "if self.options.reset: pass",
        "if self.callback is not None and self.callback: pass",
        "try: self.camera\n            except AttributeError: pass",
        "with suppress(AttributeError): self.camera",
        "if getAlliance() == Alliance.kRed: pass",
        "if self.pad.getPOV() == 90: pass",
        "if (self.name or 'auto') == 'auto': pass",
        "if self.pad.getAButton() or None: pass",
        "if self.encoder.get() == 2: pass",
        "self.done = True",
        "a.onTrue(c)",
        "self.pad.getRawButton(1)",
        "commands2.button.JoystickButton(c, self.fire)",
    ],
)
def test_lines_without_a_mistake(line: str) -> None:
    assert hints(f"class Robot:\n    def go(self, a, c):\n            {line}\n") == []


def test_a_comparison_in_a_test_is_no_assertion() -> None:
    test = """
    def test_it(control):
        control.mode == 3
        with pytest.raises(ValueError):
            control.mode == 4
    """
    assert hints(test, is_test=True) == [
        "2: this comparison does nothing: no one looks at its result / Write assert control.mode == 3"
    ]


def test_a_librarys_method_with_the_name_of_one_that_makes_a_command() -> None:
    robot = """
    class Drive(commands2.Subsystem):
        def __init__(self):
            self.timer = wpilib.Timer()
            self.timer.restart()
        def restart(self):
            return commands2.cmd.none()
        def go(self):
            {}.restart()
    """
    assert hints(robot.format("self.timer")) == []
    (found,) = hints(robot.format("self"))
    assert "self.restart() makes a command, and nothing runs it" in found


def test_a_command_whose_end_condition_returns_nothing() -> None:
    command = """
    class Go(commands2.Command):
        def isFinished(self):
            self.pid.atSetpoint()
    class Wait(commands2.Command):
        def isFinished(self):
            return False
    class Drive(commands2.Command):
        def isFinished(self):
            return self.pid.atSetpoint
    """
    nothing, function = hints(command)
    assert nothing.startswith("2: isFinished returns nothing")
    assert function == (
        "9: self.pid.atSetpoint is a function, which counts as true whatever it would return"
        " / Write self.pid.atSetpoint()"
    )


@pytest.mark.parametrize(
    ("made", "use", "start", "effect"),
    [
        ("Timer()", "get()", "restart()", "so it stays at 0 s"),
        ("Timer()", "hasElapsed(2)", "start()", "so it stays at 0 s"),
        ("AddressableLED(9)", "setData(data)", "start()", "so it stays dark"),
        ("Notifier(print)", "setName('a')", "startPeriodic(0.1)", "so its function is never called"),
    ],
)
def test_what_is_used_and_never_started(made: str, use: str, start: str, effect: str) -> None:
    robot = f"""
    class Robot:
        def robotInit(self):
            self.part = wpilib.{made}
        def go(self, data):
            used = self.part.{use}
    """
    (found,) = hints(robot)
    assert found.startswith(f"3: self.part is never started, {effect} / Write self.part.")
    for started in (f"self.part.{start}", "helper(self.part)", "part = self.part"):
        assert hints(f"{dedent(robot)}        {started}\n") == []


def test_a_timer_that_is_only_reset_is_started_there() -> None:
    found, *_ = hints("timer = wpilib.Timer()\ntimer.reset()\nt = timer.get()")
    assert found == "2: timer is never started, so it stays at 0 s / Write timer.restart() in place of reset()."


def test_a_stick_that_is_read_at_the_start() -> None:
    robot = """
    class MyRobot:
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.drive.setDefaultCommand(Drive({}self.stick.getY()))
    """
    (found,) = hints(robot.format("-"))
    assert found.startswith("4: robotInit runs once, so this is the stick's position at the start")
    assert "write lambda: -self.stick.getY()" in found
    assert hints(robot.format("lambda: -")) == []


def test_keys_of_the_dashboard_in_two_spellings() -> None:
    put = "wpilib.SmartDashboard.putNumber('Shooter Speed', 1)\n"
    got = "wpilib.SmartDashboard.getNumber({!r}, 0)"
    (found,) = find_unmatched_keys([source(put + got.format("ShooterSpeed"))])
    assert str(found.text) == "this asks the dashboard for 'ShooterSpeed', and robot.py:1 puts 'Shooter Speed'"
    for key in ("Shooter Speed", "Arm Speed"):  # a dashboard may set the other
        assert list(find_unmatched_keys([source(put + got.format(key))])) == []


def test_a_timer_that_is_never_read() -> None:
    assert hints("timer = wpilib.Timer()\ntimer.reset()") == []


@pytest.mark.parametrize(
    ("line", "written"),
    [
        ("commands2.cmd.sequence(a, a)", "commands2.cmd.sequence"),
        ("commands2.cmd.print_('a').withTimeout(3)", "commands2.cmd.print_"),
        ("self.runOnce(a)", "self.runOnce"),
        ("commands2.WaitCommand(3)", "commands2.WaitCommand"),
    ],
)
def test_a_command_that_is_not_returned(line: str, written: str) -> None:
    robot = """
    class Robot:
        def __init__(self, chooser):
            chooser.addOption("Fetch", self.fetch())
        def fetch(self, a):
            {}
    """
    (found,) = hints(robot.format(line))
    assert found == (
        f"5: fetch() returns nothing, so robot.py:3 gets None, and not the command / Write return {written}(...)"
    )
    for right in (f"return {line}", f"{line}.schedule()", f"a.onTrue({line})", "self.run()", "a.fetch()"):
        assert hints(robot.format(right)) == []


@for_each(
    "line, found",
    [
        (
            "take = self.go()\n        take.withTimeout(2)",
            "a new command, which nothing uses; take is unchanged / Write take = take.withTimeout(2)",
        ),
        (
            "a.onTrue(commands2.cmd.runOnce(lambda: self.go()))",
            "self.go() makes a command, which runOnce() throws away: it never runs / Write self.go() in place of",
        ),
        ("a.onTrue(commands2.cmd.runOnce(self.go))", "self.go() makes a command, which runOnce() throws away"),
        (
            "return commands2.cmd.sequence(self.run(a), commands2.cmd.none())",
            "self.run(a) never ends by itself, so what follows it never begins / Write self.run(a).withTimeout(2)",
        ),
        ("return self.go().andThen(self.go())", "self.go() never ends by itself"),
        ("a.onTrue(commands2.cmd.none().schedule())", "onTrue() got None, from commands2.cmd.none().schedule(), which"),
        (
            "a.onTrue(commands2.InstantCommand(self.stop()))",
            "self.stop() runs here, once, and InstantCommand() gets None",
        ),
        ("a.onTrue(lambda: self.stop())", "onTrue() got the function lambda: self.stop(), and no command"),
    ],
)
def test_a_command_that_never_runs(line: str, found: str) -> None:
    robot = f"""
    class Arm:
        def go(self): return self.run(self.stop)
        def stop(self): self.motor = 1
        def bind(self, a):
            {line}
    """
    (hint,) = hints(robot.replace("\n        take.", "\n            take."))
    assert found in hint.replace("lambda :", "lambda:")  # as Python 3.10 writes it


def test_commands_of_a_robot_that_does_not_run_them() -> None:
    robot = "class Robot(wpilib.TimedRobot):\n    def bind(self, a, c): a.onTrue(c)\n"
    (found,) = hints(robot)
    assert found.startswith("1: no command ever runs: Robot is a wpilib.TimedRobot")
    assert hints(robot.replace("a.onTrue(c)", "a.onTrue(c); commands2.CommandScheduler.getInstance().run()")) == []
    assert hints(robot.replace("wpilib.TimedRobot", "commands2.TimedCommandRobot")) == []


@for_each(
    "line, found",
    [
        (
            "self.go().schedule()",
            "each time this line starts a new command, which ends the one before / Move it to tel",
        ),
        ("if self.c: self.c.schedule()", "starts the command again, as soon as it has ended"),
        ("if self.pad.getAButtonPressed(): self.c.schedule()", ""),
        ("self.timer.restart()", "each time self.timer.restart() starts again from 0 / Move it to teleopInit."),
        ("if self.done: self.timer.restart()", ""),
        ("t = wpilib.Timer()", "makes a new Timer in each loop, which knows nothing of the last one / Write self.t = "),
        ("self.drive.arcadeDrive(1, 0)", ""),
        ("self.motor.set(50)", "power is from -1 to 1, so 50 is full power / If it is in percent, write 0.5"),
        ("self.motor.set(-1)", ""),
        ("self.motor.setVoltage(12)", ""),
    ],
)
def test_what_is_done_in_each_loop(line: str, found: str) -> None:
    robot = f"""
    class Robot:
        def robotInit(self):
            self.timer = wpilib.Timer()
            self.motor = wpilib.PWMSparkMax(1)
            self.done = False
            self.timer.start()
        def go(self): return self.run(self.stop)
        def teleopPeriodic(self):
            {line}
    """
    got = hints(robot)
    assert [found in each for each in got] == [True] * bool(found), got


@for_each(
    "line, right",
    [
        ("Rotation2d(90)", "Rotation2d.fromDegrees(90)"),
        ("Rotation2d(1)", ""),
        ("Pose2d(1, 2, 90)", "Pose2d(1, 2, Rotation2d.fromDegrees(90))"),
        ("Pose2d(1, 20, Rotation2d())", ""),
        ("math.sin(self.gyro.getAngle())", "math.sin(math.radians(self.gyro.getAngle()))"),
    ],
)
def test_an_angle_in_degrees_where_radians_belong(line: str, right: str) -> None:
    text = f"import math\nfrom wpimath.geometry import Pose2d, Rotation2d\ndef go(self):\n    return {line}\n"
    assert [f"Write {right}" in each for each in hints(text)] == [True] * bool(right)


def test_a_mode_outside_of_the_robots_class() -> None:
    (found,) = hints("class Robot: pass\ndef teleopPeriodic(self): pass\n")
    assert found.startswith("2: WPILib never calls teleopPeriodic: it is outside of the robot's class")


def test_a_test_with_a_robot_of_its_own_and_late_inputs() -> None:
    (found,) = hints("def test_set(hal_data):\n    hal_data['pwm'][0]['value'] = 1\n", is_test=True)
    assert found.startswith("2: hal_data['pwm'][0]['value'] = 1 sets an output")
    test = """
    import unittest
    class MyRobot(wpilib.TimedRobot): pass
    class TestIt(unittest.TestCase):
        def test_it(self):
            MyRobot()
    def test_late(control, hal_data):
        control.run_test(lambda tm: tm < 1)
        hal_data["dio"][0]["value"] = True
    """
    found = hints(test, is_test=True)
    assert [each[:30] for each in found] == [
        "3: TestIt is a unittest.TestCa",
        "5: MyRobot() makes a robot tha",
        "8: hal_data['dio'][0]['value']",
    ]


def test_a_command_that_nothing_uses() -> None:
    (found,) = hints("def go(a):\n    commands2.cmd.sequence(a)\ndef main(a):\n    go(a)\n")
    assert found.startswith("2: commands2.cmd.sequence(a) makes a command, and nothing runs it")


def test_a_method_that_is_defined_twice() -> None:
    robot = """
    class Robot:
        def go(self): pass
        def stop(self): pass
        def go(self): pass
        @property
        def speed(self): return 1
        @speed.setter
        def speed(self, value): pass
    def test_it(): pass
    def test_it(): pass
    def old(): pass
    kept = old
    def old(): pass
    if kept:
        def other(): pass
    else:
        def other(): pass
    """
    two, one = hints(robot)
    assert one.startswith("4: Robot.go is defined twice: only this one is called, and the one in line 2 never")
    assert two.startswith("10: test_it is defined twice")


def test_the_alliance_is_read_before_it_is_known() -> None:
    early = """
    class Robot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.is_red = wpilib.DriverStation.getAlliance() == wpilib.DriverStation.Alliance.kRed
    """
    (found,) = hints(early)
    assert found.startswith("3: the alliance is not known yet in robotInit: getAlliance() is None until")
    assert "Read it in autonomousInit and teleopInit" in found
    assert hints(early.replace("= wpilib.DriverStation.get", "= lambda: wpilib.DriverStation.get")) == []
    assert hints(early + "\n        def autonomousInit(self): self.alliance = getAlliance()\n") == []
    assert hints(early.replace("robotInit", "teleopInit")) == []


@for_each(
    "text, message",
    [
        ("[tool.pyfcr.match]\n", "pyproject.toml:1: [tool.pyfcr] has no effect: nothing reads this name"),
        ("[tool.robopty]\nrequires = []\n", "pyproject.toml:1: [tool.robopty] has no effect: nothing reads this name"),
        ("[tools.pyfrc]\nteam = 1\n", "pyproject.toml:1: [tools.pyfrc] has no effect: nothing reads this name"),
        ("[tool.robotpy]\nteam = 1\n", "pyproject.toml:2: team under [tool.robotpy] has no effect"),
        ("[tool.robotpy]\nrobotpy_extras = []\n", "pyproject.toml:2: robotpy_extras under [tool.robotpy]"),
        ("[tool.pyright]\n[tool.pytest.ini_options]\n[tool.robotpy]\nother = 1\n[project]\nname = 'x'\n", ""),
    ],
)
def test_a_misspelled_name_in_the_settings(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "pyproject.toml").write_text(text)
    project = SimpleNamespace(pyproject=tmp_path / "pyproject.toml")
    found = list(find_misspelled_settings(project))  # type: ignore[arg-type]
    assert len(found) == bool(message)
    assert all(str(each).startswith(message) for each in found)


def test_repeated_lines_are_shown_once_with_a_count() -> None:
    assert shortened("a\nb\nb\n\nb\nc\n") == "a\nb\n(the line above: 2 times more)\nc\n"
    assert shortened("late\n\n" * 300) == "late\n\n(the line above: 299 times more)\n"
    assert shortened("1\n2\n1\n") == "1\n2\n1\n"
    lines = RepeatedLines()
    pieces = ["x\n", "x", "y\n", "xy\n", "x", "y\nz", "z\n"]
    assert [lines.feed(each) for each in pieces] == [
        *("x\n", "", "xy\n", "", "", "(the line above: 2 times more)\nz", "z\n"),
    ]
    assert lines.end() == ""
