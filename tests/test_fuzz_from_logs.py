"""`pyfrc fuzz --from`: fuzzed matches begin with a recorded one."""

from __future__ import annotations

from pyfrc_core.fuzz.guidance.seed_schedule import SeedScheduler
from pyfrc_core.fuzz.inputs.match_plan import BaseMatch
from pyfrc_core.runtime.scripts.script import InputScript, Step

#: It fails only after a sequence that no random match has: three buttons in this order, then a stick.
ROBOT = """
    import wpilib

    ORDER = [7, 2, 5]

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            wpilib.DataLogManager.start()
            wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())
            self.pad = wpilib.Joystick(0)
            self.motor = wpilib.PWMSparkMax(0)
            self.done = 0

        def teleopPeriodic(self):
            self.motor.set(0.1 * self.done)
            for button in range(1, 11):
                if self.pad.getRawButtonPressed(button):
                    right = self.done < len(ORDER) and ORDER[self.done] == button
                    self.done = self.done + 1 if right else self.done if self.done == len(ORDER) else 0
            if self.done == len(ORDER) and self.pad.getRawAxis(1) < -0.5:
                raise ValueError("the order was entered")
"""
SETTINGS = "[tool.pyfrc.fuzz]\nmatch_seconds = 4.0\n"

STEPS = "\n".join(
    f'{{"t": {1.5 + 0.2 * index:.2f}, "set": {{"joysticks[0].buttons[{button}]": {pressed}}}}}'
    for index, (button, pressed) in enumerate((button, p) for button in (7, 2, 5) for p in ("true", "false"))
)
ENTERED = f"""{{"format": "pyfrc-input 1", "end": 5.0}}
{{"t": 1, "set": {{"mode": "teleop"}}}}
{STEPS}
{{"t": 4.5, "set": {{"mode": "disabled"}}}}
"""


def robot() -> dict[str, str]:
    return {"robot.py": ROBOT, "pyproject.toml": SETTINGS, "entered.jsonl": ENTERED}


def test_a_recorded_match_that_fails_is_found_at_once(make_project) -> None:
    project = make_project(
        robot() | {"failed.jsonl": ENTERED.replace('"mode": "disabled"', '"joysticks[0].axes[1]": -1')}
    )
    result = project.run("fuzz", "--runs", "1", "--from", "failed.jsonl")
    assert result.code == 1, result.output
    assert "ValueError: the order was entered" in result.stdout


def test_what_a_robot_does_not_have_is_left_out(make_project) -> None:
    recorded = ENTERED.replace('"mode": "teleop"', '"mode": "teleop", "dio[4].value": false, "CAN.Gyro.Yaw": 3.0')
    project = make_project(robot() | {"other.jsonl": recorded})
    result = project.run("fuzz", "--runs", "2", "--from", "other.jsonl")
    assert result.code == 0, result.output


def test_what_cannot_be_read_is_refused(make_project) -> None:
    project = make_project(robot())
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
