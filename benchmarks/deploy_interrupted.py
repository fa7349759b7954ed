"""What is left on a robot when `pyfrc deploy` is interrupted: link cut, laptop or agent killed, power pulled.

Run it as root on Linux with ``python benchmarks/deploy_interrupted.py [CUTS [KILLS]]``, from an environment with
pyfrc's development requirements.

CUTS times (300 by default) the link is cut while new contents are deployed over a program that runs, at points that are
spread over all bytes in both directions. KILLS times (100), at random points, the laptop's process or the agent is
killed, or the robot's power is pulled. After each, the program that the robot would start must be the old or the new
one, complete, and the next deploy must work without help. It fails at the first that does not.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(CHECKOUT / "tests"))
from roborio import Proxy, Roborio, missing_here  # noqa: E402

CUTS, KILLS = 300, 100
ROBOT = """\
import wpilib

print("this is version {number}.", flush=True)


class MyRobot(wpilib.TimedRobot):
    pass
"""
#: What the command line of each agent on the robot has; as a pattern that does not match itself.
_AGENT = "the agent has not [a]rrived"
_SECONDS = 120

Files = Mapping[str, bytes]


def version(number: int) -> Files:
    """Return the files of one version of the program: some are the same in each, some its own."""
    same, own = random.Random(0), random.Random(number)
    return {
        "robot.py": ROBOT.format(number=number).encode(),
        **{f"same/module_{each}.py": f"x = {same.random()}\n".encode() for each in range(20)},
        **{f"parts/module_{each}.py": f"y = {own.random()}\n".encode() for each in range(10)},
        **{f"deploy/path_{each}.bin": own.randbytes(4_000) for each in range(5)},
        f"only_in_{number}.txt": b"only here\n",
    }


def write(project: Path, files: Files) -> None:
    """Make these the files of the project."""
    for file in project.rglob("*"):
        if file.is_file() and ".pyfrc" not in file.parts and file.relative_to(project).as_posix() not in files:
            file.unlink()
    for path, content in files.items():
        (project / path).parent.mkdir(parents=True, exist_ok=True)
        (project / path).write_bytes(content)


def on_robot(robot: Roborio) -> Files | None:
    """Return the files of the program that the robot would start now; None: there is none."""
    if not (robot.home / "robotCommand").is_file():
        return None
    directory = robot.home / "py"
    files = [file for file in directory.rglob("*") if file.is_file() and "__pycache__" not in file.parts]
    return {file.relative_to(directory).as_posix(): file.read_bytes() for file in files if file.name != "deploy.json"}


def start_deploy(project: Path, where: str) -> subprocess.Popen[str]:
    """Begin `pyfrc deploy`."""
    command = [sys.executable, "-m", "pyfrc", "deploy", "--skip-tests", "-n", "--robot", where]
    return subprocess.Popen(command, cwd=project, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def kill_agents(robot: Roborio) -> None:
    """Kill the agent and its compiler on the robot."""
    robot.run("sh", "-c", f"for p in /proc/[0-9]*; do grep -q '{_AGENT}' $p/cmdline && kill -9 ${{p#/proc/}}; done")


def pull_power(robot: Roborio) -> None:
    """Pull the power, and give it again."""
    robot.power_off()
    robot.power_on()


@dataclass(frozen=True)
class Interruption:
    """One way to interrupt a deploy.

    :param act: what happens once enough bytes have gone by, with the robot and the deploy's process; None: the link
        is cut at this byte
    """

    name: str
    act: Callable[[Roborio, subprocess.Popen[str]], object] | None = None


CUT = Interruption("link cut")
KILLED = [
    Interruption("laptop killed", lambda robot, process: process.send_signal(signal.SIGKILL)),
    Interruption("agent killed", lambda robot, process: kill_agents(robot)),
    Interruption("power pulled", lambda robot, process: pull_power(robot)),
]


def interrupted(project: Path, robot: Roborio, how: Interruption, to_robot: bool, after: int) -> tuple[int, str, bool]:
    """Deploy, and interrupt it once so many bytes have gone in one direction.

    :returns: the exit code, the output, and whether it came to the interruption
    """
    limits = {} if how.act else {"cut_to_robot" if to_robot else "cut_from_robot": after}
    with Proxy((robot.host, robot.port), **limits) as proxy:
        process = start_deploy(project, f"{proxy.host}:{proxy.port}")
        came = False
        while how.act is not None and process.poll() is None and not came:
            if (proxy.bytes_to_robot if to_robot else proxy.bytes_from_robot) >= after:
                how.act(robot, process)
                came = True
            time.sleep(0.0005)
        output = process.communicate(timeout=_SECONDS)[0]
        return process.returncode, output, came or proxy.has_cut


class Trial:
    """One robot, to which one version of a program after the other is deployed."""

    def __init__(self, project: Path, robot: Roborio) -> None:
        self._project, self._robot = project, robot
        self._number = 0
        self._old: Files = {}
        self._new = version(0)
        self.counts: Counter[str] = Counter()
        for _ in range(2):  # afterwards the agent is on the robot
            self._deploy_whole()
        with Proxy((robot.host, robot.port)) as proxy:
            write(project, self._new)
            output, code = self._finish(start_deploy(project, f"{proxy.host}:{proxy.port}"))
            assert code == 0, output
            self.bytes = {True: proxy.bytes_to_robot, False: proxy.bytes_from_robot}
        self._next()

    def _next(self) -> None:
        self._number += 1
        self._old, self._new = self._new, version(self._number)

    @staticmethod
    def _finish(process: subprocess.Popen[str]) -> tuple[str, int]:
        return process.communicate(timeout=_SECONDS)[0], process.returncode

    def _deploy_whole(self) -> None:
        write(self._project, self._new)
        output, code = self._finish(start_deploy(self._project, self._robot.where))
        if code != 0 or on_robot(self._robot) != self._new:
            raise AssertionError(f"the next deploy needs help (exit code {code}):\n{output}")
        self._next()

    def run(self, how: Interruption, to_robot: bool, after: int) -> None:
        """Interrupt one deploy, look at what the robot would start, and deploy again."""
        write(self._project, self._new)
        code, output, came = interrupted(self._project, self._robot, how, to_robot, after)
        self._robot.wait_for_end_of_deploy()
        found = on_robot(self._robot)
        kind = "old" if found == self._old else "new" if found == self._new else "BROKEN"
        self.counts[f"{how.name}: {'not reached' if not came else f'{kind} program'}"] += 1
        if kind == "BROKEN" or "Traceback" in output or (code == 0 and kind != "new"):
            raise AssertionError(f"{how.name} at byte {after} ({'to' if to_robot else 'from'} the robot):\n{output}")
        if how.name == "power pulled":
            self._robot.said(f"this is version {self._number - (kind == 'old')}.")
        self._deploy_whole()


def main(cuts: int, kills: int) -> None:
    """Interrupt so many deploys, and print what was left on the robot."""
    with tempfile.TemporaryDirectory() as directory, Roborio() as robot:
        trial = Trial(Path(directory), robot)
        print(f"a deploy sends {trial.bytes[True]} bytes to the robot and {trial.bytes[False]} from it", flush=True)
        for number in range(cuts):
            to_robot = number % 2 == 0
            trial.run(CUT, to_robot, 1 + number * trial.bytes[to_robot] // cuts)
        numbers = random.Random(1)
        for number in range(kills):
            to_robot = numbers.random() < 0.5
            trial.run(KILLED[number % len(KILLED)], to_robot, numbers.randrange(trial.bytes[to_robot]))
        for what, count in sorted(trial.counts.items()):
            print(f"{count:5}  {what}")
        print("each time the next deploy needed no help")


if __name__ == "__main__":
    if missing := missing_here():
        sys.exit(f"error: a look-alike of a roboRIO needs {', '.join(missing)}")
    os.environ.setdefault("PYTHONUNBUFFERED", "1")
    main(*(int(text) for text in sys.argv[1:]) if len(sys.argv) > 1 else (CUTS, KILLS))
