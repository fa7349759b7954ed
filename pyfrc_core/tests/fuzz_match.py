"""The match of the ready-made fuzz test, which imports this when it runs: it takes long, and few projects need it."""

from __future__ import annotations

import gc
import os
import random
from collections.abc import Sequence
from pathlib import Path
from types import FunctionType

from ..fuzz.guidance.lines import RobotLines
from ..fuzz.inputs.asked_controls import watch_controls
from ..fuzz.inputs.input_generator import InputGenerator
from ..fuzz.inputs.match_plan import plan_match, seconds_of, without_restarts
from ..fuzz.inputs.network_reads import watch_network_reads
from ..fuzz.inputs.robot_constants import find_constants
from ..fuzz.match.play import FuzzRun
from ..project import Project, find_project
from ..runtime.exceptions import TestFroze
from ..runtime.scripts.script import InputScript
from ..test_support.controller import TestController
from ..test_support.fake_time import FakeTime
from ..text_files import keep_out_of_version_control
from ..wpi import station

#: The directory of the project for scripts of failing matches.
_SCRIPTS = Path(".pyfrc", "fuzz")

#: The maximum number of runs to shrink a script.
_MOST_RUNS = 300


def play_match(control: TestController, fake_time: FakeTime, robot: object) -> None:
    """Run the test's robot through a whole match with random inputs; if it fails, save the shortest script of that."""
    __tracebackhide__ = True
    clock, project, seed = fake_time.run.clock, control.project or find_project(), control.seed
    with watch_network_reads(project.files) as reads, watch_controls() as asked:
        rng = random.Random(f"fuzz {seed}")  # not the generator that the robot's code uses
        settings = project.settings.match
        seconds = seconds_of(settings)
        generator = InputGenerator(
            rng,
            fake_time.run,
            plan=without_restarts(plan_match(rng, seconds, settings, project.game_specific_messages)),
            seconds=seconds,
            network_reads=reads,
            constants=find_constants(_functions(project, robot)),
            asked_controls=asked.targets,
            auto_joysticks=project.auto_joysticks,
        )
        fuzz_run = FuzzRun(fake_time.run, generator)
        fuzz_run.write()
        try:
            control.run_test(fuzz_run.on_packet)
        except (Exception, TestFroze) as error:
            print(
                f"The robot failed at {clock.now:.2f} s of a match with random inputs, in {station.mode_name()} mode."
            )
            _save(project, fuzz_run.script(project.main_file.name, seed), generator, error)
            raise


def _functions(project: Project, robot: object) -> Sequence[FunctionType]:
    """Return the functions of the robot's code."""
    functions = RobotLines(project.files).functions
    if any(type(each) is FunctionType and each not in functions for each in vars(type(robot)).values()):
        gc.unfreeze()  # those of the process that was forked
        functions = RobotLines(project.files).functions
        gc.freeze()
    return functions


def _save(project: Project, script: InputScript, generator: InputGenerator, error: BaseException) -> None:
    """Shrink the script, and save it where a run with the same seed finds it, outside version control."""
    from ..fuzz.campaign.describe import story_of
    from ..fuzz.campaign.executors import shrink_in_subprocess
    from ..fuzz.match.work import ShrinkTask
    from ..fuzz.oracle.failure import failure_of

    failure = failure_of(error, project.files)
    task = ShrinkTask(script, failure, dict(generator.inputs), _MOST_RUNS, use_oracle=False)
    shrunk = shrink_in_subprocess(project, task)
    file = project.root / _SCRIPTS / f"seed-{script.seed}.jsonl"
    (script if isinstance(shrunk, str) else shrunk.script).save(file)
    keep_out_of_version_control(project.root / _SCRIPTS.parts[0])
    shown = os.path.relpath(file) if file.is_relative_to(Path.cwd()) else str(file)
    if isinstance(shrunk, str):
        print(f"The whole script, {len(script.steps)} changes from seed {script.seed}, is saved: {shrunk}.")
    else:
        story = story_of(shrunk.script, shrunk.failure)
        print("The shortest script of the failure:\n", *(f"    {line}" for line in story), sep="\n")
    print(f"\nTo repeat the failure:\n\n    pyfrc replay {shown}\n")
