"""How true the simulator's real time is, how fast it goes when it may, and how fast it goes back: the template's robot.

    python benchmarks/sim_speed.py [--seconds 60]

Makes the project in a temporary directory, with the physics that `pyfrc create-physics` writes. Needs no window.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation, Snapshot


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="how long to compare robot time with the wall's")
    seconds = parser.parse_args().seconds
    with TemporaryDirectory() as directory:
        for command in ("init", "create-physics"):
            subprocess.run([sys.executable, "-m", "pyfrc", command], cwd=directory, check=True, capture_output=True)
        project = Project(Path(directory).resolve() / "robot.py")
        real_time(project, seconds)
        as_fast_as_it_goes(project)
        going_back(project)


def real_time(project: Project, seconds: float) -> None:
    """Robot time beside the wall's, and the times between packets."""
    with Simulation(project) as simulation:
        simulation.wait_for(lambda: simulation.status.state == "running" and time_of(simulation) > 0.5)
        drive(simulation)
        seen: list[tuple[float, float]] = []

        def look() -> bool:
            if not seen or time_of(simulation) != seen[-1][1]:
                seen.append((time.perf_counter(), time_of(simulation)))
            return seen[-1][1] - seen[0][1] >= seconds

        simulation.wait_for(look)
        began_wall, began = seen[0]
        drifts = [(wall - began_wall - (now - began)) * 1000 for wall, now in seen]
        gaps = [(after[0] - before[0]) * 1000 for before, after in pairwise(seen)]
        print(f"real time, {seconds:g} s: {len(gaps) / (seen[-1][0] - began_wall):.2f} packets a second heard of")
        print(f"  drift at the end {drifts[-1]:+.2f} ms, at most {max(map(abs, drifts)):.2f} ms")
        print(f"  between packets: median {statistics.median(gaps):.2f} ms, longest {max(gaps):.2f} ms")
        status = simulation.status
        print(f"  the robot took {status.packet_seconds * 1000:.2f} ms for a packet; late: {status.late_packets}")


def as_fast_as_it_goes(project: Project) -> None:
    """A practice match, and five minutes of driving, with nobody watching and nothing recorded."""
    for what, begin in (("practice match", Simulation.practice), ("driving", drive)):
        with Simulation(project, SimOptions(speed=0, paused=True, recording=False)) as simulation:
            simulation.wait_for(lambda: simulation.status.state == "paused")
            begin(simulation)
            began = time.perf_counter()
            simulation.run_until(300)
            simulation.wait_for(lambda: time_of(simulation) >= 300)
            print(f"as fast as it goes, {what}: {300 / (time.perf_counter() - began):.0f} times real time")


def going_back(project: Project) -> None:
    """After five minutes of driving, to minute two."""
    with Simulation(project, SimOptions(speed=0, paused=True)) as simulation:
        simulation.wait_for(lambda: simulation.status.state == "paused")
        drive(simulation)
        simulation.run_until(120)
        simulation.wait_for(lambda: time_of(simulation) >= 120 and simulation.status.state == "paused")
        there = simulation.snapshot
        simulation.run_until(300)
        simulation.wait_for(lambda: time_of(simulation) >= 300 and simulation.status.state == "paused")
        began = time.perf_counter()
        simulation.rewind(120)
        simulation.wait_for(lambda: simulation.status.state == "paused")
        took = time.perf_counter() - began
        same = robots_values(simulation.snapshot) == robots_values(there)
        print(f"back from 300 s to 120 s: {took:.2f} s; the robot is the same: {same}")


def drive(simulation: Simulation) -> None:
    """In a wide circle."""
    simulation.enable()
    simulation.set_axis(0, 1, -0.7)
    simulation.set_axis(1, 1, -0.6)


def robots_values(snapshot: Snapshot | None) -> dict[str, object]:
    """Values of a snapshot without the joysticks, which are released when a person goes back."""
    values = {} if snapshot is None else snapshot.values
    return {path: value for path, value in values.items() if not path.startswith("joysticks")}


def time_of(simulation: Simulation) -> float:
    """Robot time."""
    snapshot: Snapshot | None = simulation.snapshot
    return -1.0 if snapshot is None else snapshot.time


if __name__ == "__main__":
    main()
