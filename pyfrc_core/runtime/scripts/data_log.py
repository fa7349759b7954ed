"""Input scripts from WPILib data logs: `wpilib.DriverStation.startDataLog`, or ``pyfrc sim --wpilog``.

A log has what the driver station sent, and the values of NetworkTables. It does not say who has published a value, so
only values that dashboards and cameras publish are inputs: the choices of choosers, preferences, the tables of
Limelight and PhotonVision, and what the user names. Robots do not log the seconds left: in their logs with autonomous
before teleoperated, they are those until the period ends. Logs of AdvantageKit and PyKit have all that under other
names (`kit_names`), and say what the robot has read from NetworkTables: what changed of it is an input. Logs of
simulations say what was written there from outside (`NETWORK_INPUTS`); their preferences are those that the code sets.

A robot is on for minutes before a match and after it: of its log, the script has the time from `_BEFORE_US` before it
is first enabled until `_AFTER_US` after it was last disabled. What was logged earlier is there when the script begins.
"""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any

from ...season import CURRENT
from ...wpi import logs, station
from ..robot_time import PACKET_US
from . import kit_names
from .modes import DS_ATTACHED, FMS_ATTACHED, mode_name, selected
from .network_targets import NETWORK_INPUTS, data_target, entry_target, parse_entry_target
from .script import InputScript, ScriptError, Step
from .sensors import HOLD, camera_of
from .targets import MATCH_TIME, MODE, OPMODE, REMAINING, plugged

#: The types of NetworkTables that a target has to name, by their names in a log.
_NAMED_TYPES = {
    "int64": "int",
    "float": "float",
    "boolean[]": "boolean[]",
    "double[]": "double[]",
    "float[]": "float[]",
    "int64[]": "int[]",
    "string[]": "string[]",
}

_ENABLED = "DS:enabled"
_FMS = "NT:/FMSInfo/"
_HAL = "/hal_data/"
#: What only logs of simulations have.
_OF_SIMULATION = f"{_HAL}power.vin_voltage"
_CAMERAS = ("NT:/limelight", "NT:/photonvision/")
_FROM_OUTSIDE = re.compile(r"NT:(/.+/selected|/Preferences/[^.].*)", re.DOTALL)

#: The part of a robot's log before and after it is enabled that is replayed, in microseconds.
_BEFORE_US, _AFTER_US = 5_000_000, 3_000_000

_STATIONS = ("unknown", "red1", "red2", "red3", "blue1", "blue2", "blue3")
#: The most bytes of the event's name and of the game message.
_MOST_TEXT_BYTES = 63
_MATCH_TYPES = ("none", "practice", "qualification", "elimination")

#: The number of controls of a joystick that is plugged in, and their initial value.
_CONTROLS: dict[str, tuple[int, Any]] = {
    "axes": (station.AXES, 0.0),
    "buttons": (station.BUTTONS, False),
    "povs": (station.POVS, station.NOT_PRESSED),
}


def script_from_log(file: Path, given: Collection[str] = ()) -> InputScript:
    """Return the inputs in a data log as a script.

    :param given: names of entries of NetworkTables that a person has set, such as ``/SmartDashboard/kP``
    :raises ScriptError: when the file is not a data log, or has no data of a driver station
    """
    try:
        records = sorted(map(_parsed, _records(file)), key=lambda record: record.at_us)
    except logs.MALFORMED as malformed:
        raise ScriptError(f"the data log cannot be read: {malformed}", where=file.name) from None
    given = {f"NT:{name}" for name in given}
    for prefix in kit_names.PREFIXES if not _has(records, _ENABLED) else ():
        if _has(records, prefix + kit_names.ENABLED):
            read = list(_of_kit(records, prefix))
            given |= _changed_from_outside(read)
            records = sorted([*records, *read], key=lambda record: record.at_us)
    sent = [record for record in records if record.name.startswith("DS:")]
    if not _has(sent, _ENABLED):
        raise ScriptError(
            "this data log has no data of a driver station",
            where=file.name,
            remedy=logs.HOW_TO_LOG_STATION,
        )
    begin_us, end_us = _part(sent, records[-1].at_us)
    first_us = PACKET_US if begin_us else 0  # what was logged before is there with the first packet
    last_us = _packet(end_us - begin_us)
    state, steps = _State(given), []
    if _has(records, _OF_SIMULATION):
        state.is_simulation = True
        state.written_outside = {
            f"NT:{parse_entry_target(target)[0]}"
            for record in records
            if record.name == NETWORK_INPUTS
            for target in record.value
        }
    others = (record for record in records if not _is_of_camera(record.name))
    for at_us, together in groupby(others, key=lambda record: max(first_us, _packet(record.at_us - begin_us))):
        written: dict[str, Any] = {}
        for record in together:
            if record.name == NETWORK_INPUTS:
                written |= record.value
                continue
            state.take(record)
        if at_us > last_us:
            break
        if at_us > 0 and (writes := {**dict(state.changes()), **written}):  # before, no driver station is connected
            steps.append(Step(at_us, writes))
    of_cameras = (record for record in records if _is_of_camera(record.name))
    seen = _seen((record for record in of_cameras if record.name not in state.written_outside), begin_us, first_us)
    steps = [*_with_match_time(steps, last_us), *(step for step in seen if step.at_us <= last_us)]
    return InputScript(tuple(sorted(steps, key=lambda step: step.at_us)), last_us + PACKET_US, file=file.name)


def _part(sent: list[logs.Record], last_us: int) -> tuple[int, int]:
    """Return the beginning and the end of what is replayed, by the log's clock.

    A robot's clock starts before its program; that of a simulation starts with it, and its log is replayed whole.

    :param sent: what the driver station has sent
    :param last_us: when the last value was logged
    """
    first_us = sent[0].at_us
    if first_us <= PACKET_US:
        return 0, last_us
    enabled = [(record.at_us, record.value) for record in sent if record.name == _ENABLED]
    first_on = next((at_us for at_us, is_on in enabled if is_on), first_us)
    last_off = last_us if enabled[-1][1] else enabled[-1][0]
    is_used = any(is_on for _, is_on in enabled)
    begin_us = max(first_us, first_on - _BEFORE_US) // PACKET_US * PACKET_US
    return begin_us, min(last_us, last_off + _AFTER_US) if is_used else last_us


def _records(file: Path) -> Iterator[logs.Record]:
    if not file.is_file():
        raise ScriptError("this is a directory, not a data log" if file.is_dir() else f"there is no file {file}")
    records = logs.records(file, ("DS:", "NT:", _HAL, NETWORK_INPUTS, *kit_names.READ), _CAMERAS)
    if records is None:
        raise ScriptError("this is not a WPILib data log", where=file.name)
    return records


def _parsed(record: logs.Record) -> logs.Record:
    return record._replace(value=json.loads(record.value)) if record.name == NETWORK_INPUTS else record


@cache
def _is_of_camera(name: str) -> bool:
    return name.startswith("NT:") and camera_of(name.removeprefix("NT:")) is not None


def _seen(records: Iterable[logs.Record], begin_us: int, first_us: int) -> Iterator[Step]:
    """Yield what cameras have measured, with the exact times: code corrects the robot's place of that time."""
    for at_us, together in groupby(records, key=lambda record: max(first_us, record.at_us - begin_us)):
        yield Step(at_us, dict(map(_measured, together)))


def _measured(record: logs.Record) -> tuple[str, Any]:
    name, type_name, value = record.name.removeprefix("NT:"), record.type_name, record.value
    if isinstance(value, bytes):
        return HOLD + data_target(name, type_name), value.hex()
    return HOLD + entry_target(name, _NAMED_TYPES.get(type_name, "")), value


def _has(records: Iterable[logs.Record], name: str) -> bool:
    return any(record.name == name for record in records)


def _of_kit(records: Iterable[logs.Record], prefix: str) -> Iterator[logs.Record]:
    """Yield what AdvantageKit or PyKit has logged, under WPILib's names.

    :param prefix: how its names begin
    """
    latest: dict[str, Any] = {}
    buttons = {name: names for names in kit_names.BUTTONS for name in names[:2]}
    for record in records:
        name = record.name.removeprefix(prefix)
        ours = kit_names.NAMES.get(name) or kit_names.entry_of(name, record.type_name)
        if ours is not None:
            yield record._replace(name=ours)
        elif name in buttons:
            count, bits, ours = buttons[name]
            latest[name] = record.value
            yield record._replace(name=ours, value=kit_names.pressed(latest.get(count), latest.get(bits)))


def _changed_from_outside(read: Iterable[logs.Record]) -> set[str]:
    """Return the entries that have several values; one that never changes has the default that the code gave it."""
    values: dict[str, Any] = {}
    read = (record for record in read if record.name.startswith("NT:"))
    return {record.name for record in read if values.setdefault(record.name, record.value) != record.value}


def _packet(at_us: int) -> int:
    """Return the time of the packet with which something arrives that was logged at this time."""
    return max(0, -(-at_us // PACKET_US)) * PACKET_US


@dataclass
class _State:
    """The latest values of a log, and what was written of them.

    :param given: the names of further entries that are inputs
    :param is_simulation: whether the log has what was written to NetworkTables from outside
    :param written_outside: the names of the entries that were written to, in the form that they have in the log
    """

    given: Collection[str] = ()
    is_simulation: bool = False
    written_outside: Collection[str] = ()
    _sent: dict[str, Any] = field(default_factory=dict)
    _fms: dict[str, Any] = field(default_factory=dict)
    _hal: dict[str, Any] = field(default_factory=dict)
    #: Values that are written to NetworkTables, by target.
    _from_outside: dict[str, Any] = field(default_factory=dict)
    _written: dict[str, Any] = field(default_factory=dict)

    def take(self, record: logs.Record) -> None:
        """Take a value of the log."""
        name, value = record.name, record.value
        if name.startswith("DS:"):
            self._sent[name.removeprefix("DS:")] = value
        elif name.startswith(_HAL):
            self._hal[name.removeprefix(_HAL)] = value
        elif name.startswith(_FMS):
            self._fms[name.removeprefix(_FMS)] = value
        if self._is_from_outside(name):
            target = entry_target(name.removeprefix("NT:"), _NAMED_TYPES.get(record.type_name, ""))
            self._from_outside[target] = value

    def changes(self) -> Iterator[tuple[str, Any]]:
        """Return what to write: nothing but the lost connection while no driver station is attached."""
        attached = self._attached()
        yield from self._changed("control.dsAttached", attached, True)
        if attached:
            for target, value, initially in self._station():
                yield from self._changed(target, value, initially)
            for stick in range(station.JOYSTICKS):
                yield from self._joystick(stick)
        for target, value in self._from_outside.items():
            yield from self._changed(target, value, None)

    def _is_from_outside(self, name: str) -> bool:
        if name in self.written_outside:
            return False
        return name in self.given or (not self.is_simulation and bool(_FROM_OUTSIDE.fullmatch(name)))

    def _changed(self, target: str, value: object, initially: object) -> Iterator[tuple[str, Any]]:
        if self._written.get(target, initially) != value:
            self._written[target] = value
            yield target, value

    def _attached(self) -> bool:
        if (attached := self._hal.get("control.dsAttached")) is not None:
            return bool(attached)
        return bool(self._fms.get("FMSControlData", DS_ATTACHED) & DS_ATTACHED)

    def _station(self) -> Iterator[tuple[str, Any, Any]]:
        """Return targets with their values now, and at the start of a run.

        A log of a simulation has both: what the robot has made of a packet comes with a turn of its loop.
        """
        fms, ours = self._fms, self._hal
        place = int(fms.get("StationNumber", 1)) + (0 if fms.get("IsRedAlliance", True) else 3)
        place = int(ours.get("alliance_station", place))
        yield "alliance_station", _named(_STATIONS, place), "red1"
        yield "control.eStop", bool(self._sent.get("estop")), False
        fms_attached = bool(ours.get("control.fmsAttached", fms.get("FMSControlData", 0) & FMS_ATTACHED))
        yield "control.fmsAttached", fms_attached, False
        name = ours.get("event.name", fms.get("EventName", station.EVENT_NAME))
        yield "event.name", _as_sent(name), station.EVENT_NAME
        yield "event.match_number", int(ours.get("event.match_number", fms.get("MatchNumber", 0))), 0
        match_type = int(ours.get("event.match_type", fms.get("MatchType", 0)))
        yield "event.match_type", _named(_MATCH_TYPES, match_type), "none"
        message = ours.get("event.game_specific_message", fms.get("GameSpecificMessage", ""))
        yield "event.game_specific_message", _as_sent(message), ""
        if (left := ours.get(REMAINING)) is not None:
            yield REMAINING, left, 0.0
        yield OPMODE, ours.get("control.opmode", ""), ""  # of the mode that follows
        yield MODE, self._mode(), "disabled"

    def _mode(self) -> str:
        enabled, autonomous, test = (self._sent.get(name) for name in ("enabled", "autonomous", "test"))
        return mode_name(enabled, selected(autonomous, test))

    def _joystick(self, stick: int) -> Iterator[tuple[str, Any]]:
        controls = {sort: self._sent.get(f"joystick{stick}/{sort}") for sort in _CONTROLS}
        if all(values is None for values in controls.values()):
            return
        is_plugged = any(controls.values())
        for target, value in self._changed(plugged(stick), is_plugged, True):
            yield target, value
            for path in [path for path in self._written if path.startswith(f"joysticks[{stick}].") and path != target]:
                del self._written[path]
        if is_plugged:
            for sort, values in controls.items():
                most, initially = _CONTROLS[sort]
                for number, value in enumerate((values or [])[:most], CURRENT.first_button if sort == "buttons" else 0):
                    yield from self._changed(f"joysticks[{stick}].{sort}[{number}]", value, initially)


def _as_sent(text: str) -> str:
    """Return a text as far as a driver station can send it: AdvantageKit has logged longer ones."""
    return text.encode("utf-8", "replace")[:_MOST_TEXT_BYTES].decode("utf-8", "ignore")


def _named(names: tuple[str, ...], number: int) -> str:
    return names[number] if 0 <= number < len(names) else names[0]


def _with_match_time(steps: list[Step], last_us: int) -> Iterator[Step]:
    if any(REMAINING in step.writes for step in steps):  # logged
        yield from steps
        return
    modes = [(step.at_us, str(step.writes[MODE])) for step in steps if MODE in step.writes]
    enabled = [mode for _, mode in modes if not mode.startswith("disabled")]
    if "autonomous" not in enabled or "teleop" not in enabled[enabled.index("autonomous") :]:
        yield from steps
        return
    if not steps or steps[0].at_us > PACKET_US:
        yield Step(PACKET_US, {REMAINING: 0.0})
    ends = dict(zip((at_us for at_us, _ in modes), [*(at_us for at_us, _ in modes[1:]), last_us], strict=True))
    for step in steps:
        writes: Mapping[str, Any] = step.writes
        if step.at_us == PACKET_US:
            writes = {REMAINING: 0.0, **writes}
        if writes.get(MODE) in ("autonomous", "teleop"):
            writes = {**writes, MATCH_TIME: (ends[step.at_us] - step.at_us) / 1_000_000}
        yield Step(step.at_us, writes)
