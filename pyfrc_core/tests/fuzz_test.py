"""Mashes the buttons and switches in random ways, to find the control situations that nobody thinks of.

Its random numbers start from the run's seed. What a failing match was told is kept as an input script: ``pyfrc replay``
has it fail again.
"""

from __future__ import annotations

import os
import random
from pathlib import Path
from typing import Any

from ..fuzz.masher import MatchMasher
from ..fuzz.match_plan import seconds_of
from ..hal import HalData, modes
from ..project import Project, find_project
from ..runtime.clock import PACKET_US
from ..runtime.scripts.script import InputScript, Step
from ..runtime.scripts.targets import Targets
from ..test_support.controller import TestController
from ..test_support.fake_time import FakeTime

__all__ = ["test_fuzz"]

#: Where scripts of failing matches are kept, in the project.
_KEPT = Path(".pyfrc", "fuzz")


def test_fuzz(hal_data: HalData, control: TestController, fake_time: FakeTime, robot: Any) -> None:
    """Runs through a whole game randomly setting components."""
    __tracebackhide__ = True
    clock, project, seed = fake_time.run.clock, control.project or find_project(), control.seed
    masher = MatchMasher(
        random.Random(f"fuzz {seed}"),  # not the generator that the robot's own code draws from
        fake_time.run,
        seconds=seconds_of(project.settings.match),
        settings=project.settings.match,
        game_messages=project.game_specific_messages,
    )
    targets, steps = Targets(hal_data), list[Step]()

    def write() -> None:
        writes = masher.writes(clock.now_us)
        if writes:
            steps.append(Step(clock.now_us, writes))
        for target, value in writes.items():
            targets.write(target, value, clock.now_us)

    def on_step(now: float) -> bool:
        write()
        targets.count_down(clock.now_us)
        return not masher.over(clock.now_us)

    write()
    try:
        control.run_test(on_step)
    except Exception:
        script = InputScript(tuple(steps), clock.now_us + PACKET_US, robot=project.main_file.name, seed=seed)
        _tell(_keep(script, project), script, clock.now)
        raise


def _keep(script: InputScript, project: Project) -> Path:
    """Write it where a next run with the same seed finds it, out of version control."""
    file = project.root / _KEPT / f"seed-{script.seed}.jsonl"
    script.save(file)
    ignored = project.root / _KEPT.parts[0] / ".gitignore"
    if not ignored.exists():
        ignored.write_text("*\n", encoding="utf-8")
    return file


def _tell(file: Path, script: InputScript, now: float) -> None:
    shown = os.path.relpath(file) if file.is_relative_to(Path.cwd()) else str(file)
    print(
        f"The robot failed at {now:.2f} s of a match with everything mashed, in {modes.mode_name()} mode.\n"
        f"What it was told, {len(script.steps)} changes from seed {script.seed}, is kept. To have it fail again:\n\n"
        f"    pyfrc replay {shown}\n"
    )
