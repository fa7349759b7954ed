"""What pyfrc adds to a competition robot's own processor time in a practice match.

    python benchmarks/competition.py [ROBOT]... [--rounds N] [--todays]

For each robot in tests/robots/competition: its code in a bare loop (bare_loop.py), and `pyfrc test` with the ready-made
practice match of the same length, without and with `--trace` and `--record`. Then the time until all ready-made tests
are done, to that of the longest alone: the practice match, or the test with random inputs, which is as long. With
`--todays` also a test of the same length, in turn with us and with the pyfrc of the 2026 season (installed beside, with
the vendors' packages), both without physics.py, since two robots' physics use what only ours has. Except for that time:
processor time of all processes of a command. Medians. It needs a POSIX system, an environment with pyfrc's development
requirements, and an idle machine.
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
import time
from collections.abc import Callable
from pathlib import Path

from comparison import TODAYS, Environment, sample_in_turn
from competition_robots import NAMES, copy_robot

HERE = Path(__file__).resolve().parent
MATCH = "\n[tool.pyfrc.match]\nbefore = 1\nautonomous = 15\npause = 3\nteleop = 135\n"
#: The targets: of the bare loop and one import, of the run without a trace, and of all tests to the longest alone.
MOST, MOST_TRACED, MOST_WALL = 1.15, 2.0, 1.15
SECONDS = 154
#: The same length in a test that both sides can run.
BOTH = """\
def test_match(control, robot):
    with control.run_robot():
        control.step_timing(seconds=1, autonomous=False, enabled=False)
        control.step_timing(seconds=15, autonomous=True, enabled=True)
        control.step_timing(seconds=3, autonomous=False, enabled=False)
        control.step_timing(seconds=135, autonomous=False, enabled=True)
"""
VENDORS = (
    *("phoenix6", "photonlibpy", "robotpy-commands-v2", "robotpy-navx", "robotpy-pathplannerlib", "robotpy-rev"),
    *("robotpy-urcl", "robotpy-wpilib-utilities"),
)
TEST = (sys.executable, "-m", "pyfrc", "test")


def main() -> None:
    """Measure each robot, print a row for each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help=f"default: {', '.join(NAMES)}")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--todays", action="store_true", help="compare with the pyfrc of the 2026 season, too")
    options = parser.parse_args()
    if unknown := set(options.robots) - set(NAMES):
        parser.error(f"no such robot: {', '.join(sorted(unknown))}")
    todays = provide_todays() if options.todays else None
    print(f"CPU seconds for a match of {SECONDS} s, medians of {options.rounds} rounds")
    names = ("bare loop", "import", "pyfrc test", "ratio", "--trace", "--record", "all tests")
    print(f"{'robot':14}" + "".join(f"{name:>11}" for name in names))
    for name in options.robots or NAMES:
        with tempfile.TemporaryDirectory(prefix="competition-", ignore_cleanup_errors=True) as directory:
            project = copy_robot(name, Path(directory), MATCH)
            shutil.rmtree(project / "tests")
            (project / "tests").mkdir()
            (project / "tests" / "all_test.py").write_text("from pyfrc.tests import *\n")
            print_row(name, project, options.rounds)
            if todays is not None:
                (project / "physics.py").unlink()
                (project / "tests" / "all_test.py").write_text(BOTH)
                print_todays(project, todays, options.rounds)


def print_row(name: str, project: Path, rounds: int) -> None:
    """Measure one robot, everything in turn in each round."""
    bare: list[dict[str, float]] = []
    spent: list[float] = []  # wall seconds of the last match

    def loop() -> float:
        bare.append(bare_loop(project))
        return bare[-1]["match"]

    def match() -> float:
        begin = time.perf_counter()
        seconds = test(project)
        spent[:] = [time.perf_counter() - begin]
        return seconds

    samples = sample_in_turn(
        {
            "loop": loop,
            "match": match,
            "trace": lambda: test(project, "--trace", "written"),
            "record": lambda: test(project, "--record", "written"),
            "alone": lambda: max(*spent, wall_seconds(project, "-k", "fuzz")),
            "together": lambda: wall_seconds(project),
        },
        rounds,
    )
    least, ours, trace, record, alone, together = map(statistics.median, samples.values())
    imports = statistics.median(each["import"] for each in bare)
    ratio, wall = ours / (least + imports), together / alone
    met = ratio <= MOST and max(trace, record) <= MOST_TRACED * ours and wall <= MOST_WALL
    verdict = "met" if met else "MISSED"
    figures = (least, imports, ours, ratio, trace / ours, record / ours, wall)
    print(f"{name:14}" + "".join(f"{figure:11.2f}" for figure in figures) + f"  {verdict}", flush=True)


def provide_todays() -> Environment:
    """Install the pyfrc of the 2026 season and the vendors' packages, beside."""
    todays = Environment("todays-vendors")
    todays.provide(*TODAYS, *VENDORS)
    return todays


def print_todays(project: Path, todays: Environment, rounds: int) -> None:
    """Compare with today's tool, in turn."""
    command = [todays.python, "-m", "robotpy", "test"]
    takes = {"ours": lambda: test(project), "todays": lambda: cpu_seconds(lambda: run(command, project))}
    ours, others = map(statistics.median, sample_in_turn(takes, rounds).values())
    print(f"{'':14}without physics: pyfrc test {ours:.2f}, today's {others:.2f}, ratio {ours / others:.2f}", flush=True)


def bare_loop(project: Path) -> dict[str, float]:
    command = [sys.executable, str(HERE / "bare_loop.py"), str(project)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"error: the bare loop of {project.name} failed:\n{done.stdout}{done.stderr}")
    figures: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return figures


def test(project: Path, *options: str) -> float:
    """Run the practice match; return the processor time of the whole command in seconds."""
    command = [*TEST, "-q", *options, "--", "-k", "practice or match"]
    return cpu_seconds(lambda: run(command, project))


def wall_seconds(project: Path, *options: str) -> float:
    """Run tests; return how long that took."""
    begin = time.perf_counter()
    run([*TEST, "-q", "--", *options], project)
    return time.perf_counter() - begin


def run(command: list[str], project: Path) -> None:
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    if done.returncode != 0 or " passed" not in done.stdout:
        sys.exit(f"error: {' '.join(command)} in {project.name}:\n{done.stdout}{done.stderr}")


def cpu_seconds(work: Callable[[], None]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    work()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


if __name__ == "__main__":
    main()
