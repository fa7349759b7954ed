"""How fast `pyfrc deploy` is, against today's upload tool, to the same look-alike of a roboRIO over a field's radio.

Run it as root on Linux with ``python benchmarks/deploy_speed.py``, from an environment with pyfrc's development
requirements, on a machine that does nothing else: laptop and robot are one machine here.

Whole commands (`pyfrc deploy --skip-tests`, `python -m robotpy deploy --skip-tests --no-install`), to a look-alike with
a real SSH server (tests/roborio), through a proxy with round trips of 20 ms and 4 Mbit/s. It prints round trips and
bytes, too. All files are compared after each deploy. Ours waits until the program has reported its start; today's does
not.
"""

from __future__ import annotations

import random
import shutil
import statistics
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from comparison import CHECKOUT, BenchmarkError, Case, Environment, compare, run

sys.path.insert(0, str(CHECKOUT / "tests"))
from roborio import Proxy, Roborio, missing_here

ROUND_TRIP = 0.020  # seconds
RATE = 500_000  # bytes a second: 4 Mbit/s
FILES, FILE_SIZE = 200, 4_000

#: Where the proxy listens: today's tool connects to port 22 only.
PROXY = "127.83.0.2"

ROBOT = """\
import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.motor = wpilib.PWMSparkMax(0)


if __name__ == "__main__":
    wpilib.run(MyRobot)
"""


@dataclass(frozen=True)
class OnTheWire:
    """What a deploy cost, as the proxy has seen it."""

    round_trips: int
    to_robot: int
    from_robot: int


def write_project(directory: Path) -> Path:
    """A robot program of 200 files, 0.8 MB; the same each time."""
    numbers = random.Random(1)
    directory.mkdir()
    (directory / "robot.py").write_text(ROBOT)
    (directory / "pyproject.toml").write_text('[tool.robotpy]\nrobotpy_version = "2026.2.2"\nrequires = []\n')
    for number in range(FILES - 2):
        lines = [f'"""Module {number}."""\n']
        while sum(map(len, lines)) < FILE_SIZE:
            name = "".join(numbers.choices("abcdefghijklmnopqrstuvwxyz_", k=12))
            lines.append(f"\ndef {name}(x):\n    return x * {numbers.random()} + {numbers.randrange(10**6)}\n")
        package = directory / f"package_{number // 20}"
        package.mkdir(exist_ok=True)
        (package / f"module_{number}.py").write_text("".join(lines))
    return directory


class Side:
    """One tool with a robot of its own.

    :param command: deploys the project in the current directory to the robot at the address that is appended
    """

    def __init__(
        self, name: str, command: list[str], project: Path, kill_script: Path | None, stack: ExitStack
    ) -> None:
        self._name = name
        self._command = command
        self._project = project
        self._new_robot = partial(Roborio, kill_script=kill_script)
        self._stack = stack
        self._robot: Roborio | None = None
        self._changes = 0
        self.costs: dict[str, list[OnTheWire]] = {}

    def first(self) -> float:
        """Seconds of a deploy to a robot with nothing on it."""
        if self._robot is not None:
            self._robot.close()
        self._robot = self._stack.enter_context(self._new_robot())
        shutil.rmtree(self._project / ".pyfrc", ignore_errors=True)  # the last robot's key
        return self._deploy("first deploy")

    def unchanged(self) -> float:
        """Seconds of a deploy of what is there already."""
        self._provide()
        return self._deploy("unchanged redeploy")

    def changed(self) -> float:
        """Seconds of a deploy after a change in one file."""
        self._provide()
        self._changes += 1
        with (self._project / "package_3/module_70.py").open("a") as file:
            file.write(f"\nCHANGE = {self._changes}\n")
        return self._deploy("one changed file")

    def _provide(self) -> None:
        if self._robot is None:
            self.first()

    def _deploy(self, what: str) -> float:
        assert self._robot is not None
        with Proxy(
            (self._robot.host, self._robot.port), round_trip=ROUND_TRIP, rate=RATE, host=PROXY, port=22
        ) as proxy:
            begin = time.perf_counter()
            output = run([*self._command, PROXY], self._project)
            seconds = time.perf_counter() - begin
            cost = OnTheWire(proxy.round_trips, proxy.bytes_to_robot, proxy.bytes_from_robot)
        on_robot = self._robot.home / "py"
        for file in self._project.rglob("*.py"):
            copy = on_robot / file.relative_to(self._project)
            if not copy.is_file() or copy.read_bytes() != file.read_bytes():
                raise BenchmarkError(f"{self._name} has not deployed {file.name}:\n{output}")
        self.costs.setdefault(what, []).append(cost)
        return seconds

    def print_costs(self) -> None:
        for what, costs in self.costs.items():
            trips, sent, got = (
                statistics.median(getattr(cost, key) for cost in costs)
                for key in ("round_trips", "to_robot", "from_robot")
            )
            print(f"{self._name:<7} {what:<20} {trips:6.0f} round trips {sent:10,.0f} bytes sent {got:10,.0f} received")


def kill_script_of(environment: Environment) -> Path:
    """The script that today's tool expects on robots: with another there, it would first replace it."""
    found = list(environment.directory.rglob("frcKillRobot.sh"))
    if len(found) != 1:
        raise BenchmarkError(f"{len(found)} kill scripts in {environment.directory}, where one was expected")
    return found[0]


def make_cases(sides: list[Side], stack: ExitStack, ours: Environment, todays: Environment, base: Path) -> list[Case]:
    """All of the cases; `sides` gets ours and today's."""
    project = write_project(base / "ours")
    other_project = shutil.copytree(project, base / "todays")
    our_command = [ours.script("pyfrc"), "deploy", "--skip-tests", "--robot"]
    their_command = [todays.python, "-m", "robotpy", "deploy", "--skip-tests", "--no-install", "--robot"]
    mine = Side("ours", our_command, project, None, stack)
    other = Side("todays", their_command, other_project, kill_script_of(todays), stack)
    sides += [mine, other]

    def case(name: str, which: Callable[[Side], float], most: float) -> Case:
        return Case(name, "s", partial(which, mine), partial(which, other), f"ratio <= {most}", lambda _, r: r <= most)

    return [
        case(f"first deploy, {FILES} files", Side.first, 0.15),
        case("unchanged redeploy", Side.unchanged, 0.08),
        case("one changed file", Side.changed, 0.15),
    ]


if __name__ == "__main__":
    if missing := missing_here():
        sys.exit(f"error: a look-alike of a roboRIO needs {', '.join(missing)}")
    with ExitStack() as stack:
        sides: list[Side] = []
        compare((__doc__ or "").partition("\n")[0], partial(make_cases, sides, stack))
        print(f"\non the wire, medians ({ROUND_TRIP * 1000:.0f} ms round trips, {RATE * 8 / 1e6:g} Mbit/s)")
        for side in sides:
            side.print_costs()
