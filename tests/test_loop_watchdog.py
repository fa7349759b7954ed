"""What WPILib's watchdogs say, in robot time, of slow loops and of what is not fed; and with which lines."""

from __future__ import annotations

import pytest
from conftest import MakeProject, RobotProject

SIMULATE = "sim", "--ui", "none", "--mode", "teleop", "--speed", "0", "--seconds"

SLOW = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.turns = 0

        def teleopPeriodic(self):
            self.turns += 1
            if self.turns in (30, 31, 99):
                wpilib.wait(0.05)
            if self.turns == 50:
                wpilib.wait(0.0199)
"""

ITS_OWN_LOOP = """
        def startCompetition(self):
            self.robotInit()
            alarm = wpilib.Timer.getFPGATimestamp()
            while True:
                self._loopFunc()
                alarm += 0.02
                wpilib.wait(max(0.001, alarm - wpilib.Timer.getFPGATimestamp()))
"""


@pytest.mark.parametrize(
    ("own_loop", "began"),
    # WPILib's loop leaves out what it has missed, three turns; this one catches up.
    [("", [0.6, 0.6 + 72 * 0.02]), (ITS_OWN_LOOP, [0.6, 0.6 + 69 * 0.02])],
    ids=["WPILib's loop", "a loop of its own"],
)
def test_turns_that_took_longer_than_their_period_are_told_once_a_second(
    own_loop: str, began: list[float], make_project: MakeProject
) -> None:
    project = make_project({"robot.py": SLOW + own_loop})
    result = project.run(*SIMULATE, "3")
    assert result.code == 0, result.output
    told = [line for line in result.output.splitlines() if "overrun:" in line]
    assert told == [
        f"Error at MyRobot: Loop time of 0.020000s overrun: the turn that began at {seconds:.3f} s took 0.050 s"
        for seconds in began
    ]
    assert "TeleopPeriodic(): 0.050000s" in result.output


WATCHDOGS = """
    import gc
    from functools import partial

    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.expired = []
            self.dogs = {name: wpilib.Watchdog(0.05, partial(self.expires, name)) for name in "abcde"}
            self.dogs["b"].suppressTimeoutMessage(True)
            for dog in self.dogs.values():
                dog.enable()
            self.dogs["c"].setTimeout(0.1)
            self.dogs["d"].disable()
            del self.dogs["e"]
            gc.collect()
            self.fed = wpilib.Watchdog(0.03, partial(self.expires, "fed"))

        def expires(self, name):
            assert self.dogs[name].isExpired()
            self.expired.append((name, round(wpilib.Timer.getFPGATimestamp(), 6)))

        def robotPeriodic(self):
            self.fed.reset()
            self.fed.addEpoch("fed")
"""

OF_WATCHDOGS = """
    import pytest
    import wpilib

    @pytest.fixture
    def step(control):
        with control.run_robot():
            yield lambda seconds: control.step_timing(seconds=seconds, autonomous=False, enabled=True)

    def test_each_expires_to_the_microsecond_and_once(step, robot):
        step(1.0)
        assert robot.expired == [("a", 0.05), ("b", 0.05), ("c", 0.1)]
        dog = robot.dogs["a"]
        assert isinstance(dog, wpilib.Watchdog) and dog.isExpired() and dog.getTimeout() == 0.05
        assert dog.getTime() == 1.0
        dog.reset()
        assert not dog.isExpired() and dog.getTime() == 0
        step(0.04)
        assert not dog.isExpired()
        step(0.02)
        assert robot.expired[3:] == [("a", 1.05)]
        assert not robot.fed.isExpired() and not robot.dogs["d"].isExpired()

    def test_what_is_not_fed_is_told_unless_it_is_to_be_silent(step, capfd):
        step(0.2)
        told = [line for line in capfd.readouterr().err.splitlines() if "Watchdog not fed" in line]
        assert told == [
            "Warning at Watchdog: Watchdog not fed within 0.050000s, at 0.050 s",
            "Warning at Watchdog: Watchdog not fed within 0.100000s, at 0.100 s",
        ]
"""


def test_watchdogs_expire_in_robot_time(make_project: MakeProject) -> None:
    project = make_project({"robot.py": WATCHDOGS, "tests/test_watchdogs.py": OF_WATCHDOGS})
    result = project.run("test")
    assert result.code == 0, result.output
    assert "2 passed" in result.stdout


CARELESS = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def teleopInit(self):
            wpilib.DriverStation.getStickAxis(9, 3)
            self.complain()

        def complain(self):
            wpilib.reportError("the arm is stuck", True)
            wpilib.reportWarning("the arm is warm", False)
            try:
                {}["arm"]
            except KeyError:
                wpilib.reportError("no arm", True)
"""


@pytest.fixture
def careless(make_project: MakeProject) -> RobotProject:
    return make_project({"robot.py": CARELESS})


def test_what_is_reported_comes_with_the_users_lines_and_no_others(careless: RobotProject) -> None:
    result = careless.run(*SIMULATE, "1")
    assert result.code == 0, result.output
    lines = result.output.splitlines()
    own = [line for line in lines if line.startswith('  File "')]
    in_robot = [
        f'  File "{careless.path / "robot.py"}", line {careless.line("robot.py", text)}, in {method}'
        for text, method in (
            ("getStickAxis", "teleopInit"),
            ("self.complain()", "teleopInit"),
            ("is stuck", "complain"),
            ('{}["arm"]', "complain"),
        )
    ]
    assert sorted(own) == sorted(in_robot)
    for said in ("stick 9 out of range", "the arm is stuck", "the arm is warm", "KeyError: 'arm'"):
        assert said in result.output
