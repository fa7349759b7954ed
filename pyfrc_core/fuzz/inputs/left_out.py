"""What a match leaves out, so that a known failure does not end it."""

from __future__ import annotations

from collections.abc import Mapping

from ...runtime.scripts.script import InputScript
from ...runtime.scripts.targets import MODE, OPMODE
from .values import Value, is_released

#: What a match leaves out: targets; of modes and opmodes one value, as ``mode=teleop``.
LeftOut = frozenset[str]


def one_of(target: str, value: object) -> str:
    """Return how one value of a target is left out."""
    return f"{target}={value}"


def needed_inputs(script: InputScript) -> tuple[str, ...]:
    """Return the targets of a script; of a script that changes only modes, the modes in which the robot is enabled.

    Of the opmodes, only those that it chooses.
    """
    targets = sorted({target for step in script.steps for target in step.writes if target not in (MODE, OPMODE)})
    opmodes = sorted({str(step.writes[OPMODE]) for step in script.steps if step.writes.get(OPMODE)})
    if targets or opmodes:
        return *targets, *(one_of(OPMODE, each) for each in opmodes)
    modes = {str(step.writes[MODE]) for step in script.steps if MODE in step.writes}
    return tuple(sorted(one_of(MODE, mode) for mode in modes if not mode.startswith("disabled")))


def without(left_out: LeftOut, writes: Mapping[str, Value]) -> dict[str, Value]:
    """Return the writes of a match that leaves these out. A control may be let go, and a mode becomes disabled."""
    found: dict[str, Value] = {}
    for target, value in writes.items():
        if target == MODE and one_of(MODE, value) in left_out:
            found[target] = "disabled"
        elif target == OPMODE and one_of(OPMODE, value) in left_out:
            found[target] = ""
        elif target not in left_out or (target.startswith("joysticks[") and is_released(target, value)):
            found[target] = value
    return found
