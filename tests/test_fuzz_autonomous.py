"""The driver station sends no joystick data in autonomous: what a driver presses there, `pyfrc fuzz` does not press."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest

from pyfrc_core.fuzz.campaign.describe import story_of
from pyfrc_core.fuzz.oracle.failure import FuzzFailure
from pyfrc_core.runtime.scripts.script import InputScript, Step, load_script

SHORT = "[tool.pyfrc.fuzz]\nmatch_seconds = 8\n"
AUTO_JOYSTICKS = '{"pyfrc": {"field": {"auto_joysticks": true}}}'

FAILS_IN_AUTONOMOUS = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)

        def autonomousPeriodic(self):
            stick = self.stick
            if abs(stick.getX()) > 0.1 or stick.getRawButton(1) or stick.getTrigger() or stick.getPOV() >= 0:
                raise ValueError("a driver moves the robot in autonomous")
    """

#: It fails with a button that is pressed in autonomous, or in the teleop after it.
FAILS_IN_EITHER = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.had_autonomous = False

        def autonomousPeriodic(self):
            self.had_autonomous = True
            self.check()

        def teleopPeriodic(self):
            if self.had_autonomous:
                self.check()

        def check(self):
            if any(map(self.stick.getRawButton, range(1, 11))):
                raise ValueError("pressed")
    """


def held_in_autonomous(script: InputScript) -> Iterable[str]:
    mode, held = "disabled", dict[str, Any]()
    for step in script.steps:
        mode = step.writes.get("mode", mode)
        held |= {target: value for target, value in step.writes.items() if ".buttons[" in target}
        if mode == "autonomous":
            yield from (target for target, pressed in held.items() if pressed)


@pytest.mark.parametrize(
    "command",
    [pytest.param(("fuzz", "--runs", "12"), marks=pytest.mark.slow), ("test", "tests/fuzz_test.py")],
)
def test_a_script_of_teleop_becomes_none_of_autonomous(command: tuple[str, ...], make_project: Any) -> None:
    project = make_project(
        {
            "robot.py": FAILS_IN_EITHER,
            "pyproject.toml": SHORT,
            "tests/fuzz_test.py": "from pyfrc.tests.fuzz_test import *\n",
        }
    )
    result = project.run(*command, "--seed", "1")
    assert result.code == 1, result.output
    (file,) = [*project.path.glob("tests/fuzz/*.jsonl"), *project.path.glob(".pyfrc/fuzz/*.jsonl")]
    script = load_script(file)
    assert not list(held_in_autonomous(script))
    modes = [step.writes["mode"] for step in script.steps if "mode" in step.writes]
    assert modes[-1] == "teleop"
    assert "autonomous" in modes


def test_a_story_names_what_is_held_at_its_end_and_straight_ahead() -> None:
    held = {"joysticks[0].axes[1]": -1.0, "joysticks[0].povs[0]": 0, "joysticks[0].axes[2]": 0.0}
    script = InputScript((Step(20_000, held), Step(1_000_000, {"joysticks[0].buttons[2]": True})), 1_040_000)
    story = story_of(script, FuzzFailure("KeyError", "robot.py:3", "f", "robot.py:3: KeyError: 3"))
    assert "button 2 pressed while axis 1 at -1 and POV 0" in " ".join(story)
