"""What `pyfrc profile` costs: how much longer the loop of a robot takes while it is measured.

Run it with ``python benchmarks/profile_cost.py``, from an environment with pyfrc's development requirements.

A sample is the processor time of 150 s of robot time, teleoperated, in a process of its own: plain, under `pyfrc
profile`, and with `-o`, which adds cProfile. The three take turns, and the least of each counts.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from functools import partial
from pathlib import Path

from comparison import sample_in_turn

HERE = Path(__file__).resolve()
ROBOTS = HERE.parents[1] / "tests" / "robots"

#: A match's length, in seconds of robot time.
SECONDS = 150
WAYS = ("plain", "profiled", "cProfile")


def measure(way: str) -> float:
    """The processor seconds that `SECONDS` of the robot in the current directory take, teleoperated."""
    process_time = time.process_time
    from pyfrc_core.measure.processes import announced
    from pyfrc_core.project import find_project
    from pyfrc_core.runtime.loading import load_robot
    from pyfrc_core.runtime.patches.install import patches
    from pyfrc_core.runtime.robot import RobotRun
    from pyfrc_core.wpi import station

    project = find_project(Path.cwd())
    with ExitStack() as closing:
        directory = closing.enter_context(tempfile.TemporaryDirectory())
        if way != "plain":
            settings = {
                "root": str(project.root),
                "directory": directory,
                "calls": way == "cProfile",
            }
            closing.enter_context(announced("profile", settings))
        patches.install(project.files)
        run = RobotRun()
        robot_class = load_robot(project)
        run.open()
        run.construct(robot_class)
        run.start()
        station.set_mode(enabled=True)
        begin = process_time()
        run.run_until(SECONDS * 1_000_000)
        seconds = process_time() - begin
        run.close()
    return seconds


def measure_apart(robot: str, way: str) -> float:
    command = [sys.executable, str(HERE), "--one", way]
    done = subprocess.run(command, cwd=ROBOTS / robot, capture_output=True, text=True, check=True)
    return float(done.stdout.splitlines()[-1])


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=7, help="samples of each, 7 by default")
    parser.add_argument("--only", action="append", metavar="ROBOT", help="only this sample robot; may be repeated")
    parser.add_argument("--one", choices=WAYS, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measure(options.one)))
        return
    print(f"{'robot':<10} {'loop':>10} {'profiled':>14} {'with cProfile':>16}")
    for robot in options.only or ("timed", "command", "magic", "square"):
        samples = sample_in_turn({way: partial(measure_apart, robot, way) for way in WAYS}, options.rounds)
        plain, profiled, calls = (min(samples[way]) for way in WAYS)
        loop = f"{plain / (SECONDS / 0.02) * 1e6:.1f} µs"
        print(f"{robot:<10} {loop:>10} {profiled / plain - 1:>+14.0%} {calls / plain - 1:>+16.0%}")


if __name__ == "__main__":
    main()
