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
from collections.abc import Collection, Iterable, Iterator, Mapping
from datetime import datetime, timezone
from functools import partial
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from typing import Any

from ...log_records import CLOCKS, READERS, SIMULATED_BOOT, TIMES, DataLog, LogEntry, Record, read_data_log
from ...wording import from_here
from ...wpi import logs
from ..robot_time import PACKET_US
from . import kit_names
from .known_entries import fit_of
from .logged_inputs import FROM_OUTSIDE, HAL, OF_STATION, LoggedInputs, as_written, target_of
from .network_targets import NETWORK_INPUTS, data_target, parse_entry_target
from .script import InputScript, ScriptError, Step
from .sensors import HOLD, camera_of
from .targets import MATCH_TIME, MODE, REMAINING

_ENABLED = "DS:enabled"
#: What only logs of simulations have.
_OF_SIMULATION = f"{HAL}power.vin_voltage"
_CAMERAS = ("NT:/limelight", "NT:/photonvision/")
#: How the names begin of the values until whose end a log is replayed.
_UNTIL = ("DS:", "NT:", HAL, NETWORK_INPUTS, *kit_names.READ)

#: What only logs of WPILib 2027 and later have.
_OF_2027 = {"DS:controlWord", "DS:opMode", "NT:/DriverStation/ControlWord"}

#: The part of a robot's log before and after it is enabled that is replayed, in microseconds.
_BEFORE_US, _AFTER_US = 5_000_000, 3_000_000


def script_from_log(file: Path, given: Collection[str] = ()) -> InputScript:
    """Return the inputs in a data log as a script.

    :param given: names of entries of NetworkTables that a person has set, such as ``/SmartDashboard/kP``
    :raises ScriptError: when it has no data of a driver station
    """
    name = from_here(file)
    log = read_data_log(file)
    kit = list(_of_kit(log))
    asked = {*(f"NT:{each}" for each in given), *_changed_from_outside(kit)}
    own = log.records(partial(_is_input, asked))
    records = [each for record in own for each in logs.as_in_2026(record) if not isinstance(each.value, bytes)]
    records = sorted(_fitted([*records, *kit]), key=attrgetter("at_us"))
    sent = [record for record in records if record.name.startswith("DS:")]
    if not any(record.name == _ENABLED for record in sent):
        why = f": {log.problem}" if log.problem else ""
        raise ScriptError(
            f"this data log has no data of a driver station{why}", where=name, remedy=logs.HOW_TO_LOG_STATION
        )
    begin_us, end_us = _part(sent, _last_us(log))
    last_us = _packet(end_us - begin_us)
    written_outside = frozenset(_written_outside(records, name))
    inputs = LoggedInputs(asked, any(entry.name == _OF_SIMULATION for entry in log.entries), written_outside)
    steps = []
    for at_us, together in groupby(records, key=lambda record: max(PACKET_US, _packet(record.at_us - begin_us))):
        if at_us > last_us:
            break
        written: dict[str, Any] = {}
        for record in together:
            if record.name == NETWORK_INPUTS:
                written |= _writes(record, name)
            else:
                inputs.take(record)
        if writes := {**dict(inputs.changes()), **written}:
            steps.append(Step(at_us, writes))
    seen = log.records(lambda entry: _is_of_camera(entry) and entry.name not in written_outside)
    first_us = PACKET_US if begin_us else 0  # what was logged before is there with the first packet
    lacks = tuple(_lacks(steps, {record.name: record.at_us - begin_us for record in reversed(sent)}, begin_us))
    steps = [*_with_match_time(steps, last_us), *_seen(seen, begin_us, first_us, last_us)]
    return InputScript(
        tuple(sorted(steps, key=attrgetter("at_us"))),
        last_us + PACKET_US,
        file=name,
        problem=log.problem,
        year=_year(log),
        lacks=lacks,
    )


def _is_input(asked: Collection[str], entry: LogEntry) -> bool:
    name = entry.name
    return name == NETWORK_INPUTS or bool(
        OF_STATION.fullmatch(name) or ((name in asked or FROM_OUTSIDE.fullmatch(name)) and not _is_of_camera(entry))
    )


def _is_of_camera(entry: LogEntry) -> bool:
    beginnings = "NT:" if entry.type_name in READERS else _CAMERAS
    return entry.name.startswith(beginnings) and camera_of(entry.name.removeprefix("NT:")) is not None


def _last_us(log: DataLog) -> int:
    """Return when the last value was logged that the robot has sent or received."""
    counted = (
        entry.moments[-1]
        for entry in log.entries
        if entry.name.startswith(_UNTIL if entry.type_name in READERS else _CAMERAS)
    )
    return max(counted) % SIMULATED_BOOT


def _year(log: DataLog) -> int | None:
    """Return the year of the WPILib that has written a log, by the names of its entries and the robot's time of day."""
    times = [record.value for record in log.records(lambda entry: entry.name in CLOCKS and entry.type_name == "int64")]
    year = datetime.fromtimestamp(times[-1] / 1e6, timezone.utc).year if times and times[-1] in TIMES else None
    if any(entry.name in _OF_2027 for entry in log.entries):
        return max(year or 2027, 2027)
    return None if year is None else min(year, 2026)


def _part(sent: list[Record], last_us: int) -> tuple[int, int]:
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


def _lacks(steps: list[Step], firsts: Mapping[str, int], begin_us: int) -> Iterator[tuple[float, str]]:
    """Yield since when, in seconds of robot time, and what a log does not have of the driver station.

    :param firsts: when the first value of each entry was logged, in microseconds of robot time
    :param begin_us: the beginning of what is replayed, by the log's clock
    """
    modes = [(step.at_us, str(step.writes[MODE])) for step in steps if MODE in step.writes]
    enabled = [(at_us, mode) for at_us, mode in modes if not mode.startswith("disabled")]
    if not enabled:
        yield 0.0, "no enabled robot"
        return
    if begin_us and enabled[0][0] <= PACKET_US:
        yield 0.0, "no beginning, since the robot is enabled when it begins"
    if not firsts.keys() & {"DS:autonomous", "DS:test"}:
        yield enabled[0][0] / 1e6, "no modes but enabled and disabled"
    driven_us = next((at_us for at_us, mode in enabled if mode != "autonomous"), None)
    of_sticks = [at_us for name, at_us in firsts.items() if name.startswith("DS:joystick") and fit_of(name)]
    first_us = min(of_sticks, default=None)
    if driven_us is not None and (first_us is None or _packet(first_us) > driven_us + PACKET_US):
        until = "" if first_us is None else f" until {_packet(first_us) / 1e6:g} s"
        yield driven_us / 1e6, f"no joysticks from {driven_us / 1e6:g} s on{until}"


def _written_outside(records: Iterable[Record], where: str) -> Iterator[str]:
    """Yield the names of the entries that a dashboard or a script has written to, as a log has them."""
    for record in records:
        if record.name == NETWORK_INPUTS:
            yield from (f"NT:{parse_entry_target(target)[0]}" for target in _writes(record, where))


def _writes(record: Record, where: str) -> dict[str, Any]:
    """Return what was written from outside.

    :raises ScriptError: when the record has something else
    """
    try:
        return dict(json.loads(record.value))
    except (TypeError, ValueError, RecursionError) as malformed:
        raise ScriptError(f"the data log cannot be read: {malformed}", where=where) from None


def _fitted(records: Iterable[Record]) -> Iterator[Record]:
    """Yield the records with the values that their names say, without those that have others."""
    for record in records:
        fit = fit_of(record.name)
        if fit is None:
            yield record
        elif (value := fit(record.value)) is not None:
            yield record._replace(value=value)


def _seen(records: Iterable[Record], begin_us: int, first_us: int, last_us: int) -> Iterator[Step]:
    """Yield what cameras have measured, with the exact times: code corrects the robot's place of that time."""
    for at_us, together in groupby(records, key=lambda record: max(first_us, record.at_us - begin_us)):
        if at_us <= last_us:
            yield Step(at_us, dict(map(_measured, together)))


def _measured(record: Record) -> tuple[str, Any]:
    if isinstance(record.value, bytes):
        return HOLD + data_target(record.name.removeprefix("NT:"), record.type_name), record.value.hex()
    return HOLD + target_of(record), as_written(record.value)


def _of_kit(log: DataLog) -> Iterator[Record]:
    """Yield what AdvantageKit or PyKit has logged, under WPILib's names, if WPILib has not logged it itself."""
    names = {entry.name for entry in log.entries}
    if any(name.startswith("DS:") for name in names):
        return
    buttons = {name: names for names in kit_names.BUTTONS for name in names[:2]}
    for prefix in kit_names.PREFIXES:
        if prefix + kit_names.ENABLED not in names:
            continue
        latest: dict[str, Any] = {}
        read = tuple(prefix + table for table in kit_names.READ)
        for record in log.records(partial(_begins_with, read)):
            name = record.name.removeprefix(prefix)
            ours = kit_names.NAMES.get(name) or kit_names.entry_of(name, record.type_name)
            if ours is not None:
                yield record._replace(name=ours)
            elif name in buttons:
                count, bits, ours = buttons[name]
                latest[name] = record.value
                yield record._replace(name=ours, value=kit_names.pressed(latest.get(count), latest.get(bits)))


def _begins_with(beginnings: tuple[str, ...], entry: LogEntry) -> bool:
    return entry.name.startswith(beginnings) and entry.type_name in READERS


def _changed_from_outside(read: Iterable[Record]) -> set[str]:
    """Return the entries that have several values; one that never changes has the default that the code gave it."""
    values: dict[str, Any] = {}
    read = (record for record in read if record.name.startswith("NT:"))
    return {record.name for record in read if values.setdefault(record.name, record.value) != record.value}


def _packet(at_us: int) -> int:
    """Return the time of the packet with which something arrives that was logged at this time."""
    return max(0, -(-at_us // PACKET_US)) * PACKET_US


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
