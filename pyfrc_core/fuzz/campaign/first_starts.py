"""What a campaign finds out before its matches: how the robot starts, with several inputs and random numbers."""

from __future__ import annotations

import linecache
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from ...project.robot_files import RobotFiles
from ...runtime.scripts.script import InputScript, Step
from ..match.work import MatchExecutor, MatchResult, ReplayTask
from ..oracle.failure import ALWAYS_SET, WHILE_DISABLED, FuzzFailure

#: A failure within this time without inputs from a driver is one of the start.
START_US = 2_000_000
#: The starts: each has a driver station of its own, and the random numbers of its index.
_STATIONS = ("unknown", "red2", "blue3", "red1")
STARTS = len(_STATIONS)


@dataclass
class FirstStarts:
    """What these starts show.

    :ivar seconds: how long the first one took, in real time
    :ivar count: how many there were
    :ivar failed: how many of them each failure has ended, by its cause
    :ivar overrides: see `MatchResult`
    :ivar published: see `MatchResult`
    :ivar always_set: the lines of code that set an output in each disabled loop, from the first on: lights, perhaps
    :ivar always_fails: how the robot fails, if it fails at each start in the same way, also one at a time and at the
        pace of real time: what a vendor simulates may respond too late on a busy computer
    :ivar unsteady: failures that did not repeat with the same inputs
    """

    seconds: float = 0.0
    count: int = 0
    failed: Counter[str] = field(default_factory=Counter)
    published: frozenset[str] = frozenset()
    overrides: tuple[str, ...] = ()
    always_set: dict[str, FuzzFailure] = field(default_factory=dict)
    always_fails: MatchResult | None = None
    unsteady: list[FuzzFailure] = field(default_factory=list)


def try_starts(executor: MatchExecutor) -> FirstStarts:
    """Start the robot some times; it stays disabled."""
    found = FirstStarts()

    def script(index: int) -> InputScript:
        steps = (Step(0, {"alliance_station": _STATIONS[index]}),) if index else ()
        whole = InputScript(steps, START_US, robot=executor.project.main_file.name, seed=index)
        return whole.with_found(ALWAYS_SET, list(found.always_set))

    def start(indices: Sequence[int], paced: bool = False) -> list[MatchResult]:
        while True:  # one such line is noted in each run
            played = list(executor.play([ReplayTask(script(index), paced=paced) for index in indices]))
            noted = [each.failure for result in played for each in result.noted if each.failure.kind == WHILE_DISABLED]
            new = {_code_at(each.place, executor.project.files): each for each in noted}
            if new.keys() <= found.always_set.keys():
                found.count += len(played)
                found.failed.update(each.failure.cause for each in played if each.failure is not None)
                return played
            found.always_set |= new

    began = time.monotonic()
    played = start([0])
    found.seconds = time.monotonic() - began
    found.published = played[0].published
    played += start(range(1, STARTS))
    found.overrides = max((each.overrides for each in played), key=len)
    failed = [(index, each.failure) for index, each in enumerate(played) if each.failure is not None]
    again = [start([index], paced=True)[0] for index, _ in failed]
    found.unsteady = [one for (_, one), other in zip(failed, again, strict=True) if not one.same_as(other.failure)]
    if len(found.failed) == 1 and found.failed.total() == found.count:
        found.always_fails = played[0]
    return found


def _code_at(place: str, files: RobotFiles) -> str:
    """Return the line of code at a place such as ``robot.py:12``."""
    file, _, line = place.rpartition(":")
    return linecache.getline(files.root + file, int(line)).strip()
