"""How soon after its start `pyfrc deploy` sends, when `pyfrc test` has passed with the same content.

    python benchmarks/deploy_after_tests.py [ROBOT]... [--rounds N]

For each robot in tests/robots/competition that repeats (passes of others are not remembered), with 1 MB of random data
beside its code: deploys to a look-alike of a roboRIO on this computer, each of new data, and `pyfrc test` before it.
Counted is the time from the start of the command to the first byte of the data on the wire. The programs do not start
there, since the look-alike has no packages of vendors. Run it as root on Linux, from an environment with pyfrc's
development requirements, on an idle machine.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from comparison import CHECKOUT
from competition_robots import NAMES, copy_robot

sys.path.insert(0, str(CHECKOUT / "tests"))
from roborio import Proxy, Roborio, missing_here
from roborio.proxy import Way

#: The robots whose passes are remembered.
REPEATING = [name for name in NAMES if name != "ctre_swerve"]
#: The target, in seconds.
MOST = 0.5
SIZE = 1_000_000
#: Short: what is measured comes after the tests.
MATCH = "\n[tool.pyfrc.match]\nautonomous = 2\npause = 1\nteleop = 2\n"


class Watched(Proxy):
    """A proxy that notes when bytes came from the laptop, and how many there were until then."""

    def __init__(self, target: tuple[str, int]) -> None:
        self.came: list[tuple[float, int]] = []
        super().__init__(target)

    def _take(self, way: Way) -> None:
        super()._take(way)
        if way.to_robot and way.under_way:
            before = self.came[-1][1] if self.came else 0
            self.came.append((time.perf_counter(), before + len(way.under_way[-1][1])))

    def first_of_last(self, size: int) -> float:
        """When the first of the last `size` bytes came."""
        begin = self.came[-1][1] - size
        return next(moment for moment, count in self.came if count > begin)


def main() -> None:
    """Deploy each robot, print a row for each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help=f"default: {', '.join(REPEATING)}")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    if unknown := set(options.robots) - set(REPEATING):
        parser.error(f"no such robot: {', '.join(sorted(unknown))}")
    if missing := missing_here():
        sys.exit(f"error: a look-alike of a roboRIO needs {', '.join(missing)}")
    print(f"load {os.getloadavg()[0]:.1f}; seconds until a deploy sends, medians of {options.rounds} rounds")
    for name in options.robots or REPEATING:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as directory, Roborio() as robot:
            project = copy_robot(name, Path(directory), MATCH)
            times = [deploy(project, robot) for _ in range(options.rounds + 1)][1:]  # the first one accepts the key
        seconds = statistics.median(times)
        verdict = "met" if seconds <= MOST else "MISSED"
        print(f"{name:14}{seconds:8.2f} ({min(times):.2f} to {max(times):.2f})  {verdict}: {MOST}", flush=True)


def deploy(project: Path, robot: Roborio) -> float:
    """Deploy new data; return the seconds until they were sent."""
    (project / "data.bin").write_bytes(os.urandom(SIZE))
    output = run("test", project=project)
    if " passed" not in output or " failed" in output:
        sys.exit(f"error: the tests of {project.name} do not pass:\n{output}")
    with Watched((robot.host, robot.port)) as proxy:
        begin = time.perf_counter()
        output = run("deploy", "-n", "--large", "--robot", f"{proxy.host}:{proxy.port}", project=project)
        if "upload " not in output or "nothing has changed since" not in output:
            sys.exit(f"error: the deploy has run the tests again, or has not sent:\n{output}")
        return proxy.first_of_last(SIZE) - begin


def run(*arguments: str, project: Path) -> str:
    command = [sys.executable, "-m", "pyfrc", *arguments]
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


if __name__ == "__main__":
    main()
