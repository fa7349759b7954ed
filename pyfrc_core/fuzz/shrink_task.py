"""What a campaign asks for when a match has failed: a shorter script, made in a separate process beside the matches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..runtime.scripts.script import InputScript
from .failure import FuzzFailure
from .inputs import Input

#: The maximum number of runs.
MOST_RUNS = 2_000


@dataclass(frozen=True)
class ShrinkTask:
    """Make a script short that has made the robot fail.

    :param script: the script of the whole match
    :param inputs: the kinds of its targets' values, as far as they are known
    :param most_runs: how many robots to run at most
    :param seconds: after this time, take the shortest script so far; None: without a limit
    :param use_oracle: whether misbehavior without an exception is a failure
    """

    script: InputScript
    failure: FuzzFailure
    inputs: Mapping[str, Input] = field(default_factory=dict)
    most_runs: int = MOST_RUNS
    seconds: float | None = None
    use_oracle: bool = True


@dataclass(frozen=True)
class Shrunk:
    """What came of it.

    :param script: the shortest script; that of the whole match if `repeats` is False
    :param failure: how the robot fails with it
    :param repeats: whether it failed again
    :param runs: how many robots were run
    """

    script: InputScript
    failure: FuzzFailure
    repeats: bool = False
    runs: int = 0
