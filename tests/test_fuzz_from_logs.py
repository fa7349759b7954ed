"""`pyfrc fuzz --from`: fuzzed matches begin with a recorded one."""

from __future__ import annotations

from pyfrc_core.fuzz.guidance.seed_schedule import SeedScheduler
from pyfrc_core.fuzz.inputs.match_plan import BaseMatch
from pyfrc_core.runtime.scripts.script import InputScript, Step

#: It fails only at a value that no random match has.
ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.pad = wpilib.Joystick(0)

        def teleopPeriodic(self):
            if self.pad.getRawAxis(1) == -0.8125:
                raise ValueError("as recorded")
"""
SETTINGS = "[tool.pyfrc.fuzz]\nmatch_seconds = 4.0\n"

#: A part of it is of a robot with other sensors.
RECORDED = """{"format": "pyfrc-input 1", "end": 3.0}
{"t": 1, "set": {"mode": "teleop", "dio[4].value": false, "CAN.Gyro.Yaw": 3.0}}
{"t": 2, "set": {"joysticks[0].axes[1]": -0.8125}}
"""


def test_a_recorded_match_that_fails_is_found_at_once_and_what_the_robot_does_not_have_is_left_out(
    make_project,
) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": SETTINGS, "recorded.jsonl": RECORDED})
    result = project.run("fuzz", "--runs", "1", "--from", "recorded.jsonl")
    assert result.code == 1, result.output
    assert "ValueError: as recorded" in result.stdout


def test_what_cannot_be_read_is_refused(make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    for name, message in (("none.wpilog", "there is no file"), ("robot.py", "robot.py:")):
        result = project.run_here("fuzz", "--from", name)
        assert result.code == 2
        assert message in result.output


def test_the_course_of_the_match_is_the_recorded_one() -> None:
    steps = (
        Step(0, {"alliance_station": "red2"}),
        Step(1_000_000, {"mode": "teleop", "joysticks[0].axes[1]": 1.0}),
        Step(1_200_000, {"hold:nt:/limelight/tx": 2.5, "hold:encoder[0].count": 3}),  # of a log; physics goes on here
        Step(2_000_000, {"joysticks[0].axes[1]": 0.0, "packet": True}),
        Step(3_000_000, {"mode": "disabled"}),
    )
    base = BaseMatch(InputScript(steps, 4_000_000), 1_500_000)
    assert [(event.at_us, event.writes) for event in base.plan()] == [
        (0, {"alliance_station": "red2"}),
        (1_000_000, {"mode": "teleop", "joysticks[0].axes[1]": 1.0}),
        (1_200_000, {"nt:/limelight/tx": 2.5}),
        (3_000_000, {"mode": "disabled"}),
    ]
    assert base.end_us(1_000_000) == 2_500_000
    assert base.end_us(9_000_000) == 4_000_000


def test_each_recorded_match_is_first_played_as_it_is() -> None:
    recorded = [InputScript((), 1_000_000), InputScript((), 2_000_000)]
    scheduler = SeedScheduler(1, recorded)
    assert [scheduler.schedule(number).base for number in (0, 1)] == [
        BaseMatch(recorded[0], 1_000_000),
        BaseMatch(recorded[1], 2_000_000),
    ]
    bases = [scheduler.schedule(number).base for number in range(2, 102)]
    assert 60 <= sum(base is not None for base in bases) <= 95
    assert [SeedScheduler(1, recorded).schedule(number).base for number in range(2, 102)] == bases
