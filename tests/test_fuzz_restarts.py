"""The robot program of a match is started again in the middle, as after a brown-out: what stays, and what is found."""

from __future__ import annotations

import random
from typing import Any

import pytest

from pyfrc_core.config.settings import MatchSettings
from pyfrc_core.fuzz.inputs.match_plan import plan_match
from pyfrc_core.runtime.scripts.boots import boots_of
from pyfrc_core.runtime.scripts.script import InputScript, Step, load_script
from pyfrc_core.runtime.scripts.targets import RESTART

#: Fails when it is started after a match in which a button was pressed.
ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.gamepad = wpilib.XboxController(0)
            wpilib.Preferences.initDouble("gear", 1.0)
            self.ratio = 1 / wpilib.Preferences.getDouble("gear")

        def teleopPeriodic(self):
            if self.gamepad.getAButton():
                wpilib.Preferences.setDouble("gear", 0.0)
    """

SCRIPT = """\
{"format": "pyfrc-input 1", "robot": "robot.py", "end": 2}
{"t": 0, "set": {"mode": "teleop"}}
{"t": 0.1, "set": {"joysticks[0].buttons[1]": true}}
{"t": 0.5, "set": {"restart": true}}
"""

TEST = """
    import pytest
    from pathlib import Path

    def test_script(control):
        with pytest.raises(Exception, match="ZeroDivisionError"):
            control.replay(Path("script.jsonl"))
    """


def test_the_parts_of_a_script() -> None:
    start = {
        "mode": "teleop",
        "match_time": 10.0,
        "joysticks[0].plugged": False,
        "joysticks[1].axes[2]": 1.0,
        "dio[3].value": True,
        "nt:/x": 2,
    }
    last = Step(3_000_000, {"mode": "disabled"})
    steps = (Step(0, start), Step(1_000_000, {"nt:/x": 3}), Step(2_000_000, {RESTART: True, "mode": "test"}), last)
    first, second = boots_of(InputScript(steps, 4_000_000))
    assert (first.start_us, first.end_us, first.steps) == (0, 2_000_000, steps[:2])
    stays = {"mode": "teleop", "match_time": 8.0, "joysticks[0].plugged": False, "nt:/x": 3}
    assert (second.start_us, second.end_us) == (2_000_000, 4_000_000)
    assert second.steps == (Step(2_000_000, stays), Step(2_000_000, {"mode": "test"}), last)
    assert boots_of(second) == [second]


def test_what_the_roborio_keeps_is_there_in_the_next_boot(make_project: Any) -> None:
    project = make_project({"robot.py": ROBOT, "script.jsonl": SCRIPT, "tests/test_it.py": TEST})
    replayed = project.run("replay", "script.jsonl")
    assert replayed.code == 1
    assert f"{project.place('robot.py', '1 / ')}: ZeroDivisionError" in replayed.output
    assert "replayed 0.50 s of robot time" in replayed.stdout, "until it failed"
    tested = project.run("test", "--", "tests/test_it.py")
    assert tested.code == 0, tested.output


def test_a_replay_without_failure(make_project: Any) -> None:
    """Robot time goes on, the match too, and controls are released."""
    code = """
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.boots = wpilib.Preferences.getInt("boots", 0) + 1
                wpilib.Preferences.setInt("boots", self.boots)
                self.stick = wpilib.Joystick(0)
                print("boot", self.boots)
                assert (self.boots, wpilib.Timer.getFPGATimestamp()) in ((1, 0.0), (2, 0.5), (3, 1.5))

            def teleopPeriodic(self):
                assert self.stick.getRawButton(1) == (self.boots == 1 and wpilib.Timer.getFPGATimestamp() > 0.09)
                assert (self.boots == 3) == wpilib.DriverStation.isFMSAttached()
        """
    third = SCRIPT + '{"t": 1.5, "set": {"restart": true, "control.fmsAttached": true}}\n'
    project = make_project({"robot.py": code, "script.jsonl": third})
    replayed = project.run("replay", "script.jsonl", "--trace", "trace.jsonl")
    lines = [line for line in replayed.stdout.splitlines() if not line.startswith(("Default ", "Not loading "))]
    assert (replayed.code, lines) == (
        0,
        [
            *("boot 1", "boot 2", "boot 3"),
            "replayed 2.00 s of robot time",
            "The script starts the robot program 3 times: the trace is that of the last start.",
        ],
    ), replayed.output


@pytest.mark.slow
def test_fuzz_starts_the_program_again(make_project: Any) -> None:
    """The value that fails in the next boot is no constant of the code, so that fuzzing alone does not write it."""
    code = """
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                assert wpilib.Preferences.getString("state", "") != str(type(self))

            def teleopPeriodic(self):
                wpilib.Preferences.setString("state", str(type(self)))
        """

    def restart_of(seed: int) -> int:
        plan = plan_match(random.Random(f"fuzz {seed} 0"), 6, MatchSettings())
        return next((event.at_us for event in plan if RESTART in event.writes), 0)

    seed = next(seed for seed in range(1000) if restart_of(seed) > 4_000_000)
    project = make_project({"robot.py": code, "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 6\n"})
    fuzzed = project.run("fuzz", "--seed", str(seed), "--runs", "1", "-j", "1")
    assert fuzzed.code == 1, fuzzed.output
    assert "in teleoperated: the robot program starts again" in fuzzed.stdout, fuzzed.output
    file = "tests/fuzz/assertionerror-robot-robotinit.jsonl"
    script = load_script(project.path / file)
    assert sum(len(step.writes) for step in script.steps) == 2
    assert project.run("replay", file).code == 1
