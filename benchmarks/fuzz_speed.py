"""What a match of `pyfrc fuzz` costs: matches a second on a robot with one motor, and the ratio to a bare loop.

    python benchmarks/fuzz_speed.py [ROBOT]... [--matches N] [--rounds N]

First the robot of test_speed.py: processor time of a match of 30 s, and how many matches two cores play in a second at
that cost. Then each robot in tests/robots/competition (by default all): the processor time of a match, in percent of
what its code takes in a bare loop (bare_loop.py) for as many seconds. Medians; the importing is not counted, since a
campaign imports once. It needs a POSIX system, an environment with pyfrc's development requirements, and an idle
machine.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from competition import SECONDS, bare_loop
from competition_robots import NAMES, copy_robot
from test_speed import write_robot

from pyfrc_core.fuzz.campaign.executors import open_match_executor
from pyfrc_core.fuzz.guidance.goals import Goal
from pyfrc_core.fuzz.guidance.seed_schedule import SeedSchedule
from pyfrc_core.fuzz.match.work import FuzzTask
from pyfrc_core.project import find_project

CORES = 2
#: The targets: matches a second on the first robot, and the ratio on the others.
MATCHES, RATIO = 60, 2.5


def main() -> None:
    """Measure, print a row for each robot."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help=f"default: {', '.join(NAMES)}")
    parser.add_argument("--matches", type=int, default=20, help="on the robot with one motor; a quarter on the others")
    parser.add_argument("--rounds", type=int, default=3, help="bare loops of each robot")
    parser.add_argument("--measure", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.measure:
        print(json.dumps(measure(Path(options.measure), options.matches)), flush=True)
        os._exit(0)
    if unknown := set(options.robots) - set(NAMES):
        parser.error(f"no such robot: {', '.join(sorted(unknown))}")
    print(f"load {os.getloadavg()[0]:.1f}, Python {sys.version.split()[0]}")
    with tempfile.TemporaryDirectory(prefix="fuzz-speed-", ignore_cleanup_errors=True) as directory:
        cpu, _ = in_new_process(write_robot(Path(directory, "one_motor")), options.matches)
        print(f"one motor: {cpu * 1000:.1f} ms of CPU for a match, {CORES / cpu:.1f} a second on {CORES} cores", end="")
        print(f" ({'met' if CORES / cpu >= MATCHES else 'MISSED'}: {MATCHES})", flush=True)
        for name in options.robots or NAMES:
            project = copy_robot(name, Path(directory), "")
            bare = statistics.median(bare_loop(project)["match"] for _ in range(options.rounds))
            cpu, seconds = in_new_process(project, max(1, options.matches // 4))
            least = bare * seconds / SECONDS
            verdict = "met" if cpu <= RATIO * least else "MISSED"
            print(f"{name:14}{cpu:8.2f} s{least:8.2f} s bare{cpu / least:8.2f} ({verdict}: {RATIO})", flush=True)


def in_new_process(project: Path, matches: int) -> tuple[float, float]:
    """Return the median CPU seconds of a match, and its seconds of robot time."""
    command = [sys.executable, __file__, "--measure", str(project), "--matches", str(matches)]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    done = subprocess.run(command, cwd=project, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"error: fuzzing {project.name} failed:\n{done.stdout}{done.stderr}")
    cpu, seconds = json.loads(done.stdout.splitlines()[-1])
    return cpu, seconds


def measure(directory: Path, matches: int) -> tuple[float, float]:
    """Play matches one after the other, as a campaign does, in which the lines of earlier ones are known."""
    project = find_project(directory)
    times: list[float] = []
    known = frozenset[Goal]()
    with open_match_executor(project, 1) as executor:
        before = cpu_seconds()
        for number in range(matches):
            task = FuzzTask(SeedSchedule(((0, f"fuzz 1 {number}"),)), known)
            (played,) = executor.play([task])
            known = known.union(played.reached)
            now = cpu_seconds()
            if played.failure is None:
                times.append(now - before)
            before = now
    if not times:
        sys.exit(f"error: {project.main_file} fails in every match")
    return statistics.median(times), project.settings.fuzz.match_seconds


def cpu_seconds() -> float:
    """Return the processor time of this process and of its children that have ended."""
    spent = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in spent)


if __name__ == "__main__":
    main()
