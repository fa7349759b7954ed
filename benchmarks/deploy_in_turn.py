"""Today's upload tool and `pyfrc deploy` in turn, with their defaults, to one look-alike of a roboRIO.

Run it as root on Linux with ``python benchmarks/deploy_in_turn.py``, from an environment with pyfrc's development
requirements. It is no test of the suite since the other tool needs an environment of its own. It measures nothing: it
fails unless each tool's program runs after each deploy.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from comparison import CHECKOUT, TODAYS, BenchmarkError, Environment, run

sys.path.insert(0, str(CHECKOUT / "tests"))
from roborio import Roborio, missing_here

ROBOT = """\
import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        print("this is {name}")


if __name__ == "__main__":
    wpilib.run(MyRobot)
"""


def main() -> None:
    """Deploy by each of them three times."""
    cache = Path(__file__).with_name(".cache").resolve()
    cache.mkdir(exist_ok=True)
    ours, todays = Environment(cache, "ours"), Environment(cache, "todays")
    ours.provide(str(CHECKOUT), always=True)
    todays.provide(*TODAYS)
    with tempfile.TemporaryDirectory() as directory, Roborio.unkind() as robot:
        home, project = Path(directory, "home"), Path(directory, "project")
        # As `robotpy sync` leaves it, where the robot needs no package that it has not.
        (home / "wpilib/2026/robotpy/pip_cache").mkdir(parents=True)
        os.environ["HOME"] = str(home)
        project.mkdir()
        (project / "pyproject.toml").write_text('[tool.robotpy]\nrobotpy_version = "2026.2.2"\nrequires = []\n')
        commands = {
            "robotpy": [todays.python, "-m", "robotpy", "deploy", "--skip-tests", "--robot", robot.where],
            "pyfrc": [ours.python, "-m", "pyfrc", "deploy", "--skip-tests", "--robot", robot.where],
        }
        for number in range(6):
            tool = ("robotpy", "pyfrc")[number % 2]
            name = f"program {number} of {tool}"
            (project / "robot.py").write_text(ROBOT.format(name=name))
            output = run(commands[tool], project)
            try:
                robot.said(f"this is {name}")
            except AssertionError as error:
                raise BenchmarkError(f"{error}\n{output}") from error
            print(f"{name} runs", flush=True)


if __name__ == "__main__":
    if missing := missing_here():
        sys.exit(f"error: a look-alike of a roboRIO needs {', '.join(missing)}")
    main()
