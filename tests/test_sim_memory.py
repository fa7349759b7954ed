"""A long simulation: its history is compressed, and memory grows little with it."""

from __future__ import annotations

import gc
import hashlib
import json
import tracemalloc
from pathlib import Path

import pytest
from sim_robots import run, settle

from pyfrc_core.project import find_project
from pyfrc_core.sim.engine import history, snapshot_builder
from pyfrc_core.sim.engine.options import SimOptions
from pyfrc_core.sim.engine.simulation import Simulation

FILES = {
    "robot.py": """
        import math

        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.left, self.right, self.count = wpilib.PWMSparkMax(0), wpilib.PWMSparkMax(1), 0

            def teleopPeriodic(self):
                self.count += 1
                self.left.set(0.8 + 0.2 * math.sin(self.count / 100))
                self.right.set(-0.5)
    """,
    "physics.py": """
        class PhysicsEngine:
            def __init__(self, physics_controller):
                self.controller = physics_controller

            def update_sim(self, hal_data, now, tm_diff):
                self.controller.drive(hal_data["pwm"][0]["value"] * 10, 1, tm_diff)
    """,
}


def trace_hash(file: Path) -> str:
    """The hash of what a saved trace says that the robot did."""
    digest = hashlib.sha256()
    for line in file.read_text(encoding="utf-8").splitlines():
        if "t" in json.loads(line):
            digest.update(line.encode())
    return digest.hexdigest()


@pytest.mark.slow
def test_memory_grows_little_with_time(make_project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "_BLOCK", 64)
    monkeypatch.setattr(snapshot_builder, "_RECENT_POINTS", 64)
    monkeypatch.setattr(snapshot_builder, "_OLDER_POINTS", 128)
    made = make_project(FILES)
    with Simulation(find_project(made.path), SimOptions(speed=0, paused=True)) as simulation:
        simulation.choose_mode("teleop")
        simulation.enable()
        run(simulation, 20)
        tracemalloc.start()
        gc.collect()
        before, _ = tracemalloc.get_traced_memory()
        run(simulation, 60)
        gc.collect()
        after, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        # 3000 changes of hal_data take 600 kB.
        assert after - before < 300_000
        whole = simulation.script()
        simulation.rewind(30)
        settle(simulation)
        assert simulation.snapshot is not None
        assert simulation.snapshot.time == 30
        run(simulation, 20)
        simulation.save_all(tmp_path / "run.jsonl")
    assert trace_hash(tmp_path / "run-1.trace.jsonl") == whole.trace
    again, first = ((tmp_path / f"{name}.trace.jsonl").read_text().splitlines()[:-1] for name in ("run", "run-1"))
    until = sum(json.loads(line).get("t", 0) <= 30 for line in first)
    assert again[:until] == first[:until]
    assert json.loads(again[-1])["t"] == 50
    replayed = made.run("replay", tmp_path / "run.jsonl")
    assert "The trace equals the recorded one." in replayed.stdout, replayed.output
