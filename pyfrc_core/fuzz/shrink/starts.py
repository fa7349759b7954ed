"""Short scripts to begin shrinking with: the last moments before a failure, after the state that led to them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby, pairwise
from typing import Any, NamedTuple

from ...runtime.clock import PACKET_US
from ...runtime.scripts.joysticks import CONTROL
from ...runtime.scripts.targets import MATCH_TIME, MODE, PLUGGED
from ..inputs.values import is_released

#: How long before the failure the kept part begins, in packets, from what is shortest to run.
_KEPT = (1, 5, 25, 100, 400)
#: Of these, with few inputs.
_KEPT_OF_FEW = (5, 100)
#: Of these, also with all changes of mode before.
_KEPT_WITH_MODES = (1, 25, 100)
#: How long each of these modes lasts, in packets.
_MODE_LASTS = 2
#: How much later than in the whole script a failure may come, in packets.
_LATER = 50


@dataclass(frozen=True)
class ScriptWrite:
    """One write of a script.

    :param number: identifies the write in the script, whatever its time and value become
    """

    at_us: int
    target: str
    value: Any = field(hash=False)  # may be a list
    number: int


class Candidate(NamedTuple):
    """A candidate: what is written, and when the run ends."""

    writes: tuple[ScriptWrite, ...]
    end_us: int


def starts_of(writes: Sequence[ScriptWrite], end_us: int) -> list[Candidate]:
    """Return short scripts that may fail as the whole script does at its end.

    What is written before the kept part is replaced by its last values, or by these and the changes of mode. The first
    ones have nothing but the mode, and the joystick or other input that was written last.
    """
    found: list[Candidate] = []
    last = next((write.target for write in reversed(writes) if write.target != MODE), "")
    device = last.partition(".")[0] if CONTROL.fullmatch(last) else last
    few = [write for write in writes if write.target == MODE or (device and write.target.startswith(device))]
    for packets in _KEPT_OF_FEW:
        cut_us = (end_us // PACKET_US - packets) * PACKET_US
        if cut_us > 0:
            found.append(_cut(few, end_us, cut_us, with_modes=False))
    for packets in _KEPT:
        # A failure may come between two packets; inputs are written with packets.
        cut_us = (end_us // PACKET_US - packets) * PACKET_US
        for with_modes in (False, True):
            if cut_us > 0 and (not with_modes or packets in _KEPT_WITH_MODES):
                start = _cut(writes, end_us, cut_us, with_modes)
                if start.end_us < end_us and start not in found:
                    found.append(start)
    return found


def transitions_without_pause(writes: Sequence[ScriptWrite]) -> int:
    """Return how often an enabled mode follows another one at once: no field and no driver station does that."""
    modes = [str(write.value) for write in writes if write.target == MODE]
    return sum(
        before != after and not before.startswith("disabled") and not after.startswith("disabled")
        for before, after in pairwise(modes)
    )


def moments_held_in_autonomous(writes: Sequence[ScriptWrite]) -> int:
    """Return at how many moments something is written in autonomous while a control is held.

    The driver station sends what the joysticks do in the other modes only.
    """
    mode, held, found = "", set[str](), 0
    for _, together in groupby(writes, key=lambda write: write.at_us):
        for write in together:
            target = write.target
            if target == MODE:
                mode = str(write.value)
            elif target.startswith("joysticks["):
                if PLUGGED.fullmatch(target) is not None:
                    stick = target.partition(".")[0]
                    held = {each for each in held if not each.startswith(stick)}
                elif CONTROL.fullmatch(target) is not None:
                    (held.discard if is_released(target, write.value) else held.add)(target)
        found += mode == "autonomous" and bool(held)
    return found


def without_idle_releases(writes: Sequence[ScriptWrite]) -> tuple[ScriptWrite, ...]:
    """Leave out what releases a control that is not pressed."""
    pressed: set[str] = set()
    kept: list[ScriptWrite] = []
    for write in writes:
        released = CONTROL.fullmatch(write.target) is not None and is_released(write.target, write.value)
        if not released or write.target in pressed:
            kept.append(write)
        (pressed.discard if released else pressed.add)(write.target)
    return tuple(kept)


def without_overwritten(writes: Sequence[ScriptWrite]) -> tuple[ScriptWrite, ...]:
    """Leave out what a later write to the same input at the same moment replaces."""
    last = {(write.at_us, write.target): write.number for write in writes}
    return tuple(write for write in writes if last[write.at_us, write.target] == write.number)


def _cut(writes: Sequence[ScriptWrite], end_us: int, cut_us: int, with_modes: bool) -> Candidate:
    earlier = [write for write in writes if write.at_us < cut_us]
    modes = [write for write in earlier if write.target == MODE] if with_modes else []
    # Robots create some of their devices when they start: what was written later still is.
    state = [
        replace(write, at_us=min(write.at_us, PACKET_US))
        for write in _last_values(earlier, cut_us)
        if not modes or write.target != MODE
    ]
    kept_us = PACKET_US
    changes = []
    for write in modes:
        changes.append(replace(write, at_us=kept_us))
        kept_us += _MODE_LASTS * PACKET_US
    kept_us += PACKET_US
    kept = [replace(write, at_us=write.at_us - cut_us + kept_us) for write in writes if write.at_us >= cut_us]
    in_order = sorted([*state, *changes, *kept], key=lambda write: write.at_us)
    return Candidate(without_overwritten(in_order), end_us - cut_us + kept_us + _LATER * PACKET_US)


def _last_values(writes: Sequence[ScriptWrite], cut_us: int) -> Iterator[ScriptWrite]:
    last = {write.target: write for write in writes}
    for write in sorted(last.values(), key=lambda write: (write.at_us, write.number)):
        if write.target == MATCH_TIME:
            left = max(0.0, float(write.value) - (cut_us - write.at_us) / 1_000_000)
            yield replace(write, value=round(left, 3))
        else:
            yield write
