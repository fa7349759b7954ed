"""Describe a script in words: "at 21.34 s in teleoperated: joystick 0 button 3 pressed while POV 90"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from types import MappingProxyType

from ...hal.rows import row_of
from ...runtime.clock import PACKET_US
from ...runtime.scripts.joysticks import CONTROL
from ...runtime.scripts.network_targets import NETWORK, parse_entry_target
from ...runtime.scripts.script import InputScript
from ...runtime.scripts.targets import MATCH_TIME, MODE, PLUGGED, REMAINING, RESTART
from ...wpi import station
from ..inputs.device_names import named
from ..inputs.values import Value, is_released
from ..oracle.failure import FuzzFailure

_MODES = {
    "disabled": "disabled",
    "autonomous": "autonomous",
    "teleop": "teleoperated",
    "test": "test",
    "disabled autonomous": "disabled before autonomous",
    "disabled test": "disabled before test",
}

#: A story of more moments than this has only the last ones: that of a script that could not be shortened.
_MOST_MOMENTS, _LAST_MOMENTS = 12, 6
#: A failure within this time after the last input is part of that moment.
_SOON_US = 5 * PACKET_US


def story_of(
    script: InputScript, failure: FuzzFailure, names: Mapping[str, str] = MappingProxyType({})
) -> tuple[str, ...]:
    """Return a line for each moment of the script; the last line describes the failure.

    :param names: the names of the robot's sensors, see `device_names`

    Of a long script, only the last moments are described. An unusual order of modes has a line of its own.
    """
    lines = []
    if unusual := _unusual_order([step.writes[MODE] for step in script.steps if MODE in step.writes]):
        lines.append(unusual)
    earlier = len(script.steps) - _LAST_MOMENTS if len(script.steps) > _MOST_MOMENTS else 0
    if earlier:
        lines.append(f"({earlier} earlier moments are in the script)")
    mode = "disabled"
    held: dict[str, Value] = {}
    for index, step in enumerate(script.steps):
        mode = step.writes.get(MODE, mode)
        name = _MODES.get(mode, mode)
        now = {target: value for target, value in step.writes.items() if target != MODE}
        gone = {found[1] for target, value in now.items() if (found := PLUGGED.fullmatch(target)) and not value}
        held = {target: value for target, value in held.items() if _stick(target) not in gone}
        if RESTART in now:
            held = {}
        what = ", ".join(_described(target, value, names) for target, value in now.items())
        if what and (still := _still_held(held, now)):
            what += f" while {still}"
        when = f"{name} begins" if MODE in step.writes else f"in {name}"
        if index >= earlier:
            lines.append(f"at {step.at_us / 1e6:.2f} s {when}" + (f": {what}" if what else ""))
        held |= now
    failed_us = max(0, script.end_us - PACKET_US)
    return (*lines, f"at {failed_us / 1e6:.2f} s: {failure.text.partition(chr(10))[0]}")


def late_failure(script: InputScript) -> float | None:
    """Return when the robot failed, in seconds, if that was not soon after the last input; else None."""
    failed_us = script.end_us - PACKET_US
    last_us = script.steps[-1].at_us if script.steps else 0
    return failed_us / 1e6 if failed_us - last_us > _SOON_US else None


def _unusual_order(modes: Sequence[str]) -> str:
    """Return in words what happens in no match that is played once; empty if this may be such a match."""
    enabled = [mode for mode in modes if not mode.startswith("disabled")]
    periods = [mode for mode, _ in groupby(modes) if not mode.startswith("disabled")]
    if "autonomous" in enabled and "teleop" in enabled[: _last(enabled, "autonomous")]:
        return "needs autonomous after teleoperated, as when a match follows practice without a restart"
    if periods.count("autonomous") > 1:
        return "needs a second autonomous, as when a match is started again without a restart"
    return ""


def _last(modes: Sequence[str], mode: str) -> int:
    return len(modes) - 1 - list(reversed(modes)).index(mode)


def _still_held(held: Mapping[str, Value], now: Mapping[str, Value]) -> str:
    """Return the controls that are held and not changed at this moment."""
    sticks = {_stick(target) for target in now} - {None}
    found = []
    for target, value in held.items():
        if target not in now and CONTROL.fullmatch(target) and not is_released(target, value):
            text = _described(target, value).removesuffix(" pressed")
            # The number of the joystick was named before.
            found.append(text.split(" ", 2)[2] if sticks == {_stick(target)} else text)
    return " and ".join(found)


def _stick(target: str) -> str | None:
    """Return the number of the joystick that a control belongs to."""
    control = CONTROL.fullmatch(target)
    return control[1] if control is not None else None


def _described(target: str, value: Value, names: Mapping[str, str] = MappingProxyType({})) -> str:
    if target == RESTART:
        return "the robot program starts again"
    control = CONTROL.fullmatch(target)
    if control is not None:
        stick, sort, number = control.groups()
        if sort == "buttons":
            return f"joystick {stick} button {number} {'pressed' if value else 'let go'}"
        if sort == "povs":
            return f"joystick {stick} POV {'let go' if value == station.NOT_PRESSED else value}"
        return f"joystick {stick} axis {number} at {_number(value)}"
    plugged = PLUGGED.fullmatch(target)
    if plugged is not None:
        return f"joystick {plugged[1]} {'plugged in' if value else 'unplugged'}"
    if target.startswith(NETWORK):
        shown = list(value) if isinstance(value, tuple) else value
        return f"{parse_entry_target(target)[0]} set to {shown!r}"
    row = row_of(REMAINING if target == MATCH_TIME else target)
    return f"{(row and row.field.called) or named(target, names)} {value!r}"


def _number(value: Value) -> str:
    return f"{value:g}" if isinstance(value, float | int) else repr(value)
