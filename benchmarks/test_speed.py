"""How fast pyfrc is, against the pyfrc of the 2026 season, side by side on this machine.

Run it with ``python benchmarks/test_speed.py``. For all its name this holds no tests: it prints figures, and says of
each target whether it was met.

The robot is a `TimedRobot` with one PWM motor and one joystick. Each side has a virtual environment of its own
(comparison.py); ours is installed anew from this checkout. Each case runs each side once to warm up, then both in turn;
the table has the medians. In cases 1 and 2 both sides run the four ready-made tests; ours isolates them in both cases.
Case 3 (loop_speed.py) is 150 simulated seconds of the enabled robot, in our loop and in WPILib's own, which another
thread steps: it needs a second core that is idle. Case 5 is case 1 as on a system that cannot fork.
"""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

from comparison import ROBOTPY_VERSION, Case, Environment, compare, run, timed

LOOP_SPEED = Path(__file__).resolve().with_name("loop_speed.py")

ROBOT = """\
import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.motor = wpilib.PWMSparkMax(1)
        self.stick = wpilib.Joystick(0)

    def teleopPeriodic(self):
        self.motor.set(self.stick.getY())
"""
PYPROJECT = f'[tool.robotpy]\nrobotpy_version = "{ROBOTPY_VERSION}"\n'

#: How many tests `test --builtin` has on either side: a run that passed fewer did not do the same.
BUILTIN_TESTS = 4


def write_robot(directory: Path) -> Path:
    """The robot project that is run: the same on both sides, in a directory of its own on each."""
    directory.mkdir()
    (directory / "robot.py").write_text(ROBOT, "utf-8")
    (directory / "pyproject.toml").write_text(PYPROJECT, "utf-8")
    return directory


def make_cases(ours: Environment, todays: Environment, directory: Path) -> list[Case]:
    """All of the cases, on one robot written into `directory`."""
    our_robot, todays_robot = write_robot(directory / "ours"), write_robot(directory / "todays")
    passed = f"{BUILTIN_TESTS} passed"
    our_test = [ours.script("pyfrc"), "test", "--builtin"]
    todays_test = [todays.python, "-m", "robotpy", "test", "--builtin"]

    def loop_speed(which: str) -> float:
        printed = run([ours.python, str(LOOP_SPEED), which], our_robot)
        return float(json.loads(printed.splitlines()[-1])["speed"])  # WPILib has printed before

    test = partial(timed, our_test, our_robot, passed)
    reused = partial(timed, [*our_test, "--isolation", "reuse"], our_robot, passed)
    isolated = partial(timed, todays_test, todays_robot, passed)
    together = partial(timed, [*todays_test, "--no-isolation"], todays_robot, passed)
    in_place, stepped = partial(loop_speed, "in-place"), partial(loop_speed, "stepped")
    our_help = partial(timed, [ours.script("pyfrc"), "--help"], our_robot, "Usage:")
    # After its help, today's ends with exit code 1, always.
    todays_help = partial(timed, [todays.python, "-m", "robotpy", "--help"], todays_robot, "usage:", ends_with=1)
    return [
        Case("isolated tests / today's default", "s", test, isolated, "ratio <= 0.25", lambda _, r: r <= 0.25),
        Case("isolated tests / --no-isolation", "s", test, together, "ratio < 1", lambda _, r: r < 1),
        Case("loop in place / loop stepped", "s/s", in_place, stepped, "ratio >= 5", lambda _, r: r >= 5),
        Case("pyfrc --help / robotpy --help", "s", our_help, todays_help, "ours <= 0.12 s", lambda t, _: t <= 0.12),
        Case("tests without fork / today's default", "s", reused, isolated, "ratio <= 0.4", lambda _, r: r <= 0.4),
    ]


if __name__ == "__main__":
    compare((__doc__ or "").partition("\n")[0], make_cases)
