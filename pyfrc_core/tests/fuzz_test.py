"""Mashes the buttons and switches in random ways, to find the control situations that nobody thinks of.

Its random numbers start from the run's seed. The shortest way to what made the robot fail is kept as an input script:
``pyfrc replay`` has it fail again.
"""

from __future__ import annotations

import os
import random
from pathlib import Path
from typing import Any

from ..fuzz.fuzz_run import FuzzRun
from ..fuzz.input_generator import InputGenerator
from ..fuzz.match_plan import seconds_of
from ..hal import HalData, modes
from ..project import Project, find_project
from ..runtime.scripts.script import InputScript
from ..test_support.controller import TestController
from ..test_support.fake_time import FakeTime

__all__ = ["test_fuzz"]

#: Where scripts of failing matches are kept, in the project.
_KEPT = Path(".pyfrc", "fuzz")

#: How many robots are run at most to make a script short.
_MOST_RUNS = 300


def test_fuzz(hal_data: HalData, control: TestController, fake_time: FakeTime, robot: Any) -> None:
    """Runs through a whole game randomly setting components."""
    __tracebackhide__ = True
    clock, project, seed = fake_time.run.clock, control.project or find_project(), control.seed
    generator = InputGenerator(
        random.Random(f"fuzz {seed}"),  # not the generator that the robot's own code draws from
        fake_time.run,
        seconds=seconds_of(project.settings.match),
        settings=project.settings.match,
        game_messages=project.game_specific_messages,
    )
    fuzz_run = FuzzRun(fake_time.run, generator)
    fuzz_run.write()
    try:
        control.run_test(fuzz_run.on_packet)
    except Exception as error:
        print(f"The robot failed at {clock.now:.2f} s of a match with everything mashed, in {modes.mode_name()} mode.")
        _keep(project, fuzz_run.script(project.main_file.name, seed), generator, error)
        raise


def _keep(project: Project, script: InputScript, generator: InputGenerator, error: Exception) -> None:
    """Write it where a next run with the same seed finds it, out of version control; as short as it can be made."""
    from ..fuzz.failure import failure_of
    from ..fuzz.shrink_apart import shrunk_apart

    shrunk = shrunk_apart(project, script, failure_of(error, project.files), generator.inputs, _MOST_RUNS)
    file = project.root / _KEPT / f"seed-{script.seed}.jsonl"
    (shrunk.script or script).save(file)
    ignored = project.root / _KEPT.parts[0] / ".gitignore"
    if not ignored.exists():
        ignored.write_text("*\n", encoding="utf-8")
    shown = os.path.relpath(file) if file.is_relative_to(Path.cwd()) else str(file)
    if shrunk.script is not None:
        print("The shortest way there:\n", *(f"    {line}" for line in shrunk.story), sep="\n")
    else:
        print(f"What it was told, {len(script.steps)} changes from seed {script.seed}, is kept: {shrunk.why_not}.")
    print(f"\nTo have it fail again:\n\n    pyfrc replay {shown}\n")
