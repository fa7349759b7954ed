"""What replaces a name of the standard library, or of WPILib, behaves as that name in every documented use."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
import stdlib_uses
from conftest import MakeProject, RobotProject

ROBOT = """
    import hal
    import wpilib

    import stdlib_uses


    class Countdown(wpilib.Notifier):
        def __init__(self):
            super().__init__(handler=self.tick)
            self.ticks = 0

        def tick(self):
            self.ticks += 1


    class MyRobot(wpilib.TimedRobot):
        pause = wpilib.wait
        failures = None

        def teleopPeriodic(self):
            if self.failures is None:
                self.use_wpilib()
                self.failures = stdlib_uses.failures()

        def use_wpilib(self):
            handle, _ = hal.initializeNotifier()
            hal.setNotifierName(notifierHandle=handle, name="arm")
            due = wpilib.RobotController.getFPGATime() + 30_000
            hal.updateNotifierAlarm(notifierHandle=handle, triggerTime=due)
            assert hal.waitForNotifierAlarm(notifierHandle=handle) == (due, 0)
            hal.stopNotifier(notifierHandle=handle)
            hal.cleanNotifier(notifierHandle=handle)
            before = wpilib.Timer.getFPGATimestamp()
            self.pause(0.5)
            assert abs(wpilib.Timer.getFPGATimestamp() - before - 0.5) < 1e-6
            countdown = Countdown()
            countdown.setName(name="countdown")
            countdown.startPeriodic(period=0.1)
            wpilib.wait(seconds=0.35)
            assert countdown.ticks == 3
            assert isinstance(countdown, wpilib.Notifier)
"""

TESTS = """
    import json
    from pathlib import Path

    import identity
    import wpilib.simulation


    def test_uses(control, robot, fake_time):
        control.set_operator_control()
        control.run_test(lambda tm: robot.failures is None)
        Path("failures.json").write_text(json.dumps(robot.failures))
        assert 0.9 < fake_time.get() < 2
        wpilib.simulation.DriverStationSim().notifyNewData()  # a static method


    def test_identity(robot):
        Path("identity.json").write_text(json.dumps(identity.identity()))
"""

#: What a name is, seen from outside: the same whether pyfrc has replaced it or not.
IDENTITY = """
    import copy
    import inspect

    import hal
    import hal.simulation
    import wpilib
    import wpilib.simulation

    FUNCTIONS = (
        *(hal.initializeNotifier, hal.updateNotifierAlarm, hal.setNotifierName),
        *(wpilib.wait, wpilib.getDeployDirectory, wpilib.getOperatingDirectory, wpilib.reportError),
        *(wpilib.DriverStation.waitForDsConnection, wpilib.simulation.DriverStationSim.notifyNewData),
        *(wpilib.simulation.stepTiming, hal.simulation.stepTiming, wpilib.simulation.waitForProgramStart),
    )
    METHODS = [getattr(wpilib.TimedRobot, name) for name in ("addPeriodic", "startCompetition", "getLoopStartTime")]


    def identity():
        for function in FUNCTIONS:
            assert copy.deepcopy(function) is function
        return [
            *([f.__name__, f.__qualname__, f.__module__, f.__doc__] for f in (*FUNCTIONS, *METHODS)),
            *([inspect.isroutine(f), inspect.isbuiltin(f), inspect.isfunction(f)] for f in FUNCTIONS),
            *([c.__name__, c.__qualname__, c.__module__] for c in (wpilib.Notifier, wpilib.Watchdog)),
            isinstance(vars(wpilib.simulation.DriverStationSim)["notifyNewData"], staticmethod),
        ]
"""

Failures = dict[str, str]


@pytest.fixture(scope="module")
def tested(make_shared_project: MakeProject) -> RobotProject:
    """A project after its tests, which used everything in robot code."""
    project = make_shared_project({"robot.py": ROBOT, "identity.py": IDENTITY, "tests/test_robot.py": TESTS})
    project.write({"stdlib_uses.py": Path(stdlib_uses.__file__).read_text("utf-8")})
    result = project.run("test")
    assert result.code == 0, result.output
    return project


@pytest.fixture(scope="module")
def failed_in_robot_code(tested: RobotProject) -> Failures:
    failures: Failures = json.loads((tested.path / "failures.json").read_text("utf-8"))
    return failures


@pytest.fixture(scope="module")
def failed_in_plain_python() -> Failures:
    done = subprocess.run([sys.executable, stdlib_uses.__file__], capture_output=True, check=True)
    failures: Failures = json.loads(done.stdout)
    return failures


@pytest.mark.parametrize("use", stdlib_uses.CHECKS)
def test_same_in_robot_code_as_in_plain_python(
    use: str, failed_in_plain_python: Failures, failed_in_robot_code: Failures
) -> None:
    assert failed_in_plain_python.get(use) is None
    assert failed_in_robot_code.get(use) is None


def test_wpilibs_names_keep_their_identity(tested: RobotProject) -> None:
    program = "import identity, json; print(json.dumps(identity.identity()))"
    plain = subprocess.run([sys.executable, "-c", program], cwd=tested.path, capture_output=True, check=True)
    assert json.loads((tested.path / "identity.json").read_text("utf-8")) == json.loads(plain.stdout)
