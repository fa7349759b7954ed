"""Recorded matches with which fuzzed ones begin: `pyfrc fuzz --from`."""

from __future__ import annotations

import random
import re
from dataclasses import dataclass

from ..runtime.clock import PACKET_US
from ..runtime.scripts.script import InputScript
from ..runtime.scripts.targets import MATCH_TIME, MODE, PACKET
from .match_plan import MatchEvent

#: The inputs that a match keeps when its other inputs are generated: the modes, and what the field does.
_COURSE = re.compile(rf"{MODE}|{MATCH_TIME}|joysticks\[\d\]\.plugged|control\..*|event\..*|time\..*|alliance_station")


@dataclass(frozen=True)
class BaseMatch:
    """A recorded match, and up to when a fuzzed one equals it.

    :param script: the inputs of the whole recorded match
    :param until_us: from then on, inputs are generated; only the modes and the field's messages are still the recorded
        ones
    """

    script: InputScript
    until_us: int

    @classmethod
    def choose(cls, script: InputScript, rng: random.Random) -> BaseMatch:
        """Return a match that leaves the recorded one at a random moment."""
        return cls(script, rng.randrange(0, max(script.end_us, 2 * PACKET_US), PACKET_US))

    def end_us(self, generated_us: int) -> int:
        """Return when the match ends: with the recorded one, or after this time of generated inputs."""
        return min(self.script.end_us, self.until_us + generated_us)

    def plan(self) -> list[MatchEvent]:
        """Return what the match takes from the recorded one, in order."""
        found = []
        for step in self.script.steps:
            writes = {
                target: value
                for target, value in step.writes.items()
                if target != PACKET and (step.at_us < self.until_us or _COURSE.fullmatch(target))
            }
            if writes:
                found.append(MatchEvent(step.at_us, writes))
        return found
