"""Avoid known failures: most matches leave out an input of each, so that they find what is behind it.

An exception ends a match. A bug that every driver meets in the first seconds would therefore hide all others. The
shortest script of a failure has only inputs that it needs, so a match without one of them does not fail in this way.
"""

from __future__ import annotations

import random
from collections.abc import Mapping

from ..runtime.scripts.script import InputScript
from ..runtime.scripts.targets import MODE
from .values import NOT_PRESSED, Value

#: What a match leaves out: targets, and modes as ``mode=teleop``.
LeftOut = frozenset[str]

#: The share of matches that leave out something of a known failure; the others show what comes with it.
_AVOIDED = 0.9


class KnownFailures:
    """The inputs of the failures that are known."""

    def __init__(self) -> None:
        self._needed: list[tuple[str, ...]] = []

    def add(self, script: InputScript) -> None:
        """Add the shortest script of a failure that ends matches."""
        needed = needed_inputs(script)
        if needed and needed not in self._needed:
            self._needed.append(needed)

    def left_out(self, rng: random.Random) -> LeftOut:
        """Choose what a match leaves out: one input of each failure, in most cases."""
        return frozenset(rng.choice(needed) for needed in self._needed if rng.random() < _AVOIDED)


def needed_inputs(script: InputScript) -> tuple[str, ...]:
    """Return the targets of a script; of a script that changes only modes, the modes in which the robot is enabled."""
    targets = sorted({target for step in script.steps for target in step.writes if target != MODE})
    if targets:
        return tuple(targets)
    modes = {str(step.writes[MODE]) for step in script.steps if MODE in step.writes}
    return tuple(sorted(f"{MODE}={mode}" for mode in modes if not mode.startswith("disabled")))


def without(left_out: LeftOut, writes: Mapping[str, Value]) -> dict[str, Value]:
    """Return the writes of a match that leaves these out. A control may be let go, and a mode becomes disabled."""
    found: dict[str, Value] = {}
    for target, value in writes.items():
        if target == MODE and f"{MODE}={value}" in left_out:
            found[target] = "disabled"
        elif target not in left_out or (target.startswith("joysticks[") and _is_released(target, value)):
            found[target] = value
    return found


def _is_released(target: str, value: Value) -> bool:
    return not target.endswith(".plugged") and (value == NOT_PRESSED if ".povs" in target else not value)
