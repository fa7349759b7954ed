"""Where a fault is named: the loop that does not end, what was bound or passed, what led to an error of the HAL."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import pytest
from conftest import MakeProject
from loops import for_each

from pyfrc_core.fuzz.oracle.failure import failure_of
from pyfrc_core.fuzz.oracle.hal_reports import hal_reports
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.exceptions import TestFroze

ARM = """
    import commands2
    import wpilib


    class SS_Arm(commands2.Subsystem):
        def __init__(self):
            super().__init__()
            self.motor = wpilib.PWMSparkMax(3)

        def go(self):
            self.motor.set(0.5)
"""

ROBOT = """
    import commands2

    from arm import SS_Arm


    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.arm = SS_Arm()
            commands2.button.CommandXboxController(0).a().onTrue(
                {}
            )
"""

PRESS = """
    def test_pressed(control, hal_data, robot):
        hal_data["joysticks"][0]["buttons"][1] = True
        control.set_operator_control()
        control.run_test(lambda now: now < 1)
"""


@pytest.mark.season_2026
@pytest.mark.parametrize(
    ("bound", "says"),
    [
        ("commands2.InstantCommand(lambda pressed: self.arm.go(), self.arm)", "<lambda>() missing 1 required"),
        ("commands2.cmd.run(self.arm.go, self.arm).withTimeout('2 s')", "withTimeout() got '2 s', a text"),
    ],
)
def test_what_was_bound_to_a_trigger_is_named_and_not_its_subsystem(
    bound: str, says: str, make_project: MakeProject
) -> None:
    pytest.importorskip("commands2")
    files = {"robot.py": ROBOT.format(bound), "arm.py": ARM, "tests/test_robot.py": PRESS}
    project = make_project(files)
    result = project.run("test", "--no-isolation")
    assert f"{project.place('robot.py', bound)}: " in result.stdout, result.output
    assert says in result.stdout
    assert "arm.py:" not in result.stdout


@pytest.fixture
def module(tmp_path: Path) -> ModuleType:
    """A robot file whose function `outer` calls what it is given."""
    file = tmp_path / "robot.py"
    text = """
        def outer(call):
            while True:
                inner(call)


        def inner(call):
            call()
    """
    file.write_text(dedent(text).lstrip())
    specification = importlib.util.spec_from_file_location("robot_that_hangs", file)
    assert specification is not None
    assert specification.loader is not None
    made = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(made)
    return made


@for_each(
    "stands_at, place, function",
    [
        ("robot.py:3", "robot.py:1", "outer"),
        ("robot.py:7", "robot.py:6", "inner"),
        ("socket.py:5", "robot.py:6", "inner"),
    ],
)
def test_the_function_of_a_hang_is_the_one_that_stands(
    stands_at: str, place: str, function: str, module: ModuleType
) -> None:
    """The interruption comes a moment later, when the code may be anywhere below."""

    def interrupt() -> None:
        raise TestFroze(f"{stands_at}: the robot code hangs here")

    with pytest.raises(TestFroze) as raised:
        module.outer(interrupt)
    assert module.__file__ is not None
    failure = failure_of(raised.value, RobotFiles(Path(module.__file__).parent))
    assert (failure.place, failure.function) == (place, function)


REPORT = """\
Error at Motor: too hot
  File "/robot/robot.py", line 12, in teleopPeriodic
    self.arm.go()
  File "/robot/arm.py", line 31, in go
    self.motor.set(2)
"""


@for_each(
    "text, expected",
    [
        (REPORT, ("Motor: too hot", "/robot/arm.py", 31, "go")),
        ("Error at Motor: too hot\nanother line\n", ("Motor: too hot", "", 0, "")),
        ("Error at Joystick 3 not available\n" + REPORT, ("Motor: too hot", "/robot/arm.py", 31, "go")),
        ("Warning at Motor: warm\n", None),
    ],
)
def test_an_error_of_the_hal_has_the_innermost_line_that_led_to_it(
    text: str, expected: tuple[str, str, int, str] | None
) -> None:
    with hal_reports() as reports:
        os.write(2, text.encode())
        assert reports.error() == expected
        assert reports.error() is None
