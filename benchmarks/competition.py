"""What pyfrc adds to a competition robot's own processor time in a practice match.

    python benchmarks/competition.py [ROBOT]... [--rounds N]

For each robot in tests/robots/competition: its code in a bare loop (bare_loop.py), and `pyfrc test` with the ready-made
practice match of the same length, without and with `--trace` and `--record`. Processor time of all processes of a
command, medians. It needs a POSIX system, an environment with pyfrc's development requirements, and an idle machine.
"""

from __future__ import annotations

import argparse
import json
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from competition_robots import NAMES, copy_robot

HERE = Path(__file__).resolve().parent
MATCH = "\n[tool.pyfrc.match]\nbefore = 1\nautonomous = 15\npause = 3\nteleop = 135\n"
#: The targets: of the bare loop and one import, and of the run without a trace.
MOST, MOST_TRACED = 1.15, 1.2
SECONDS = 154


def main() -> None:
    """Measure each robot, print a row for each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help=f"default: {', '.join(NAMES)}")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    if unknown := set(options.robots) - set(NAMES):
        parser.error(f"no such robot: {', '.join(sorted(unknown))}")
    print(f"CPU seconds for a match of {SECONDS} s, medians of {options.rounds} rounds")
    print(f"{'robot':14}{'bare loop':>10}{'import':>8}{'pyfrc test':>12}{'ratio':>8}{'--trace':>9}{'--record':>10}")
    for name in options.robots or NAMES:
        with tempfile.TemporaryDirectory(prefix="competition-", ignore_cleanup_errors=True) as directory:
            project = copy_robot(name, Path(directory), MATCH)
            shutil.rmtree(project / "tests")
            (project / "tests").mkdir()
            (project / "tests" / "practice_test.py").write_text("from pyfrc.tests import test_practice\n")
            print_row(name, project, options.rounds)


def print_row(name: str, project: Path, rounds: int) -> None:
    """Measure one robot, everything in turn in each round."""
    bare: list[dict[str, float]] = []
    plain, traced, recorded = [], [], []
    for _ in range(rounds):
        bare.append(bare_loop(project))
        plain.append(test(project))
        traced.append(test(project, "--trace", "written"))
        recorded.append(test(project, "--record", "written"))
    loop, imports = (statistics.median(each[key] for each in bare) for key in ("match", "import"))
    ours, trace, record = map(statistics.median, (plain, traced, recorded))
    ratio = ours / (loop + imports)
    verdict = "met" if ratio <= MOST and max(trace, record) <= MOST_TRACED * ours else "MISSED"
    figures = f"{loop:10.2f}{imports:8.2f}{ours:12.2f}{ratio:8.2f}{trace / ours:9.2f}{record / ours:10.2f}"
    print(f"{name:14}{figures}  {verdict}", flush=True)


def bare_loop(project: Path) -> dict[str, float]:
    command = [sys.executable, str(HERE / "bare_loop.py"), str(project)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"error: the bare loop of {project.name} failed:\n{done.stdout}{done.stderr}")
    figures: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return figures


def test(project: Path, *options: str) -> float:
    """Run the practice match; return the processor time of the whole command in seconds."""
    command = [sys.executable, "-m", "pyfrc", "test", "-q", *options]
    return cpu_seconds(lambda: run(command, project))


def run(command: list[str], project: Path) -> None:
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    if done.returncode != 0 or "1 passed" not in done.stdout:
        sys.exit(f"error: {' '.join(command)} in {project.name}:\n{done.stdout}{done.stderr}")


def cpu_seconds(work: Callable[[], None]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    work()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


if __name__ == "__main__":
    main()
