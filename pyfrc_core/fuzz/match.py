"""One match in a process of its own, mashed or as a script says, and what came of it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..physics.construct import construct
from ..project import Project
from ..runtime.clock import PACKET_US, to_us
from ..runtime.endings import TestEnded, TestRanTooLong
from ..runtime.loading import load_robot
from ..runtime.loop_limit import LoopLimit
from ..runtime.redirect import redirection
from ..runtime.robot import RobotRun
from ..runtime.scripts.player import Player
from ..runtime.scripts.script import InputScript, ScriptError
from ..runtime.seeds import seed_generators
from ..runtime.watchdog import Watchdog
from .failure import Failure, failure_of
from .inputs import Input
from .judge import judged
from .lines import Line, RobotLines
from .masher import MatchMasher
from .mashing import Mashing
from .recipes import Recipe

if TYPE_CHECKING:
    from ..runtime.own_process import LastWords

#: What the robot's own random generators start from, as in tests that say nothing else: else a script that was found
#: here would do something else there.
ROBOT_SEED = 0


@dataclass(frozen=True)
class Mash:
    """To be done: mash a match.

    :param known: the lines that are reached already
    :param diary: a file for what is written, in case that the process ends before it can tell
    """

    recipe: Recipe
    known: frozenset[Line] = frozenset()
    diary: Path | None = None


@dataclass(frozen=True)
class Follow:
    """To be done: run the robot as a script says.

    :param judged: whether more than exceptions is a failure
    """

    script: InputScript
    judged: bool = True


Task = Mash | Follow


@dataclass(frozen=True)
class Played:
    """What came of a match.

    :param failure: what went wrong, if something did
    :param script: what was written, until then
    :param reached: the lines it was the first to reach, and when, in microseconds
    :param inputs: what the robot has to be mashed, by target
    """

    failure: Failure | None
    script: InputScript
    reached: dict[Line, int] = field(default_factory=dict)
    inputs: dict[str, Input] = field(default_factory=dict)


def play(project: Project, task: Task, words: LastWords) -> Played:
    """Do one task; the process is its own, and ends with it.

    :param words: where to leave word when the robot's code cannot be stopped
    """
    if isinstance(task, Follow):
        return _follow(project, task, words)
    return _mash(project, task, words)


@lru_cache(maxsize=1)
def robot_lines(project: Project) -> RobotLines:
    """The lines of the robot, which is imported when this is first asked for."""
    load(project)
    return RobotLines(project.files)


def load(project: Project) -> type[Any]:
    """Import the robot program, and its physics.

    :raises RobotCodeError: when its code fails
    """
    redirection.install(project.files)
    robot_class = load_robot(project)
    if project.physics_file.is_file():
        from ..physics.engine import load_physics

        load_physics(project)
    return robot_class


def _mash(project: Project, task: Mash, words: LastWords) -> Played:
    lines = robot_lines(project)
    seconds = project.settings.fuzz.match_seconds
    chance = task.recipe.chance()
    before_us = 0
    with _robot(project, words, ROBOT_SEED) as run, ExitStack() as closing:
        masher = MatchMasher(
            chance,
            run,
            seconds=seconds,
            settings=project.settings.match,
            game_messages=project.game_specific_messages,
        )
        mashing = Mashing(run, masher, closing.enter_context(task.diary.open("wb", 0)) if task.diary else None)

        def step(now: float) -> None:
            nonlocal before_us
            task.recipe.turn(chance, before_us, run.clock.now_us)
            before_us = run.clock.now_us
            if not mashing.on_packet(now):
                run.clock.halted = True

        run.clock.before_packet.insert(0, step)
        run.clock.limit_us = max(run.clock.limit_us, to_us(seconds) + PACKET_US)
        failure = None
        with lines.watched(task.known, lambda: run.clock.now_us) as reached:
            try:
                construct(project, run, load(project))
                mashing.write()
                run.start()
                run.run_until(run.clock.limit_us + 1)
            except (TestEnded, TestRanTooLong):
                pass
            except BaseException as error:  # robot code may call exit(), too
                failure = failure_of(error, project.files)
        return Played(failure, mashing.script(project.main_file.name, ROBOT_SEED), dict(reached), masher.inputs)


def _follow(project: Project, task: Follow, words: LastWords) -> Played:
    script = task.script
    with _robot(project, words, script.seed, task.judged) as run:
        failure = None
        try:
            construct(project, run, load(project))
            Player(script, run).play()
        except ScriptError:  # what it writes to is not there, since nothing has had the robot make it
            pass
        except (TestEnded, TestRanTooLong):
            pass
        except BaseException as error:  # robot code may call exit(), too
            failure = failure_of(error, project.files)
        end_us = run.clock.now_us + PACKET_US
        steps = tuple(step for step in script.steps if step.at_us < end_us)
        return Played(failure, InputScript(steps, end_us, robot=script.robot, seed=script.seed))


@contextmanager
def _robot(project: Project, words: LastWords, seed: int, is_judged: bool = True) -> Iterator[RobotRun]:
    """A run, open, watched and judged. It is not ended: its process is."""
    load(project)  # before robot time begins
    run = RobotRun()
    settings = project.settings.fuzz
    watchdog = Watchdog(run, project.files, settings.hang_seconds, words.write, words.descriptor)
    with watchdog.watching():
        run.open()
        words.follow(run)
        LoopLimit(run, project.files, project.settings)
        with judged(run, project.files, settings) if is_judged else nullcontext():
            seed_generators(seed)
            yield run
