"""What a match leaves out, so that a known failure does not end it."""

from __future__ import annotations

from collections.abc import Mapping

from ...runtime.scripts.script import InputScript
from ...runtime.scripts.targets import MODE
from .values import Value, is_released

#: What a match leaves out: targets, and modes as ``mode=teleop``.
LeftOut = frozenset[str]


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
        elif target not in left_out or (target.startswith("joysticks[") and is_released(target, value)):
            found[target] = value
    return found
