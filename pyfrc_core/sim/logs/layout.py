"""What the entries of a log mean: which are the mode, the robot's place, the joysticks and the output.

Known are the names of WPILib's `DataLogManager` and `DriverStation`, of AdvantageKit and PyKit (`kit_names`), of the
driver station's own logs (`ds_log`), and of pyfrc. Everything else is shown as a value of NetworkTables, under the name
that it has there: AdvantageKit and PyKit publish their values in a table that their logs leave out.
"""

from __future__ import annotations

import math
import re
from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from datetime import datetime, timedelta, timezone
from typing import Any

from ...log_records import CLOCKS, SIMULATED_BOOT, TIMES
from ...physics.pose import METRES_PER_FOOT
from ...runtime.robot_time import PACKET_US
from ...runtime.scripts import kit_names
from ...runtime.scripts.known_entries import fit_of
from ...runtime.scripts.modes import AUTONOMOUS, ENABLED, SELECTED_BY_NUMBER, STOPPED, TEST, mode_name, selected
from ...season import CURRENT
from ..engine.messages import MODE, POSE, TYPE, VALUE
from ..engine.past_run import Happened, PastRun, Stream
from ..engine.value_history import MISSING, ValueHistory
from .columns import Column, LogHistory, ReadLog

_HAL, _STATION, _NETWORK = "/hal_data/", "DS:", "NT:"
#: The entries with the output of a robot.
_OUTPUT = re.compile(r"(NT:)?/?((Real|Replay)Outputs/)?(messages|console|DSEvents)", re.IGNORECASE)
_EPOCH = datetime(1970, 1, 1, tzinfo=timezone.utc)
#: The entries of the mode, in the order in which they are looked for: enabled, autonomous, test, emergency stop.
_MODES = (
    ("DS:enabled", "DS:autonomous", "DS:test", "DS:estop"),
    ("/hal_data/control.enabled", "/hal_data/control.autonomous", "/hal_data/control.test", "/hal_data/control.eStop"),
)
#: Those of the driver station's log.
_STATION_MODE = ("/DSLog/Enabled", "/DSLog/Autonomous")
_CONTROL = "NT:/FMSInfo/FMSControlData"
#: The words of 2027's driver station.
_WORDS = ("DS:controlWord", "NT:/DriverStation/ControlWord")
#: What only logs of 2027 have; their POVs have a bit for each direction: up, right, down, left.
_OF_2027 = ("DS:controlWord/enabled", "DS:opMode")
_POVS = {1: 0, 3: 45, 2: 90, 6: 135, 4: 180, 12: 225, 8: 270, 9: 315}
#: Values that are marked when they become true, or 1 in logs of PyKit.
_ALARMS = {"/SystemStats/BrownedOut": "brownout", "/DSLog/Brownout": "brownout", "/DSLog/Watchdog": "watchdog"}
#: The names of the robot's place, the most certain first.
_PLACES = (
    r"/pose",
    r".*/Odometry/Robot",
    r".*Field\w*/Robot(/0)?",
    r".*(estimat(ed|or)|odometry|robot|bot|drive|fused)_?pose(2d)?",
    r".*/pose",
)
#: In so many places code may have put a robot that does not move on its field.
_PLACINGS = 10
#: What a `Field2d` may call the robot.
_FIELD_OBJECT = re.compile(r"/Robot$|pose$", re.IGNORECASE)
_NO_PLACE = re.compile(r"vision|target|goal|tag|set_?point|camera|ghost|desired|limelight", re.IGNORECASE)


def run_of(log: ReadLog, name: str, height: float) -> PastRun:
    """Return the run that a log has.

    :param name: for people
    :param height: that of the field, in feet
    """
    begin = first_moment(log)
    columns = log.columns
    end = max([begin, *(column.moments[-1] for column in columns.values() if column.moments)])
    known = dict(_fitted({**dict(_of_kit(columns)), **columns}))
    hal = dict(_station(known))
    for each, column in known.items():
        if each.startswith(_HAL):
            hal[each.removeprefix(_HAL)] = column
    table = kit_names.TABLE if kit_names.is_of_a_kit(log.types) else ""
    paths = {each: _path(each, table) for each in (*columns, *log.types) if not each.startswith(_HAL)}
    network = {path: columns[each] for each, path in paths.items() if each in columns}
    for each, type_name in log.types.items():
        if each in paths:
            network[TYPE + paths[each].removeprefix(VALUE)] = Column.of([min(begin, 0)], [type_name])
    if (mode := _mode(known)) is not None:
        network[MODE] = mode
    if (place := _place(columns, height)) is not None:
        network[POSE] = place
    happened = [*log.happened, *_output(columns), *_alarms(columns)]
    end = max([end, *(round(each.time * 1e6) for each in happened)])
    happened = [each._replace(time=max(each.time - begin / 1e6, 0.0)) for each in happened]
    happened.sort(key=lambda each: each.time)
    seconds = (end - begin) / 1e6
    if log.problem:
        happened.append(Happened(seconds, "warning", f"{name}: {log.problem}.", is_mark=True))
    histories: dict[Stream, ValueHistory] = {
        "hal": LogHistory(hal, begin, end),
        "network": LogHistory(network, begin, end),
    }
    return PastRun(name, seconds, histories, tuple(happened))


def first_moment(log: ReadLog) -> int:
    """Return the moment that is shown as 0: that of the first value of those that change, as a packet.

    Up to a twentieth of the values may have begun before: those of dashboards have the time when they were published.
    """
    if log.begin is not None:
        return log.begin
    columns = log.columns.values()
    firsts = [column.moments[0] for column in columns if len(column.moments) > 1]
    firsts = sorted(firsts or [column.moments[0] for column in columns if column.moments])
    first = min([*firsts[len(firsts) // 20 :][:1], *(round(each.time * 1e6) for each in log.happened[:1])], default=0)
    since_boot = first % SIMULATED_BOOT
    return first - since_boot if since_boot <= PACKET_US else first // PACKET_US * PACKET_US


def _path(name: str, table: str) -> str:
    """Return the path of an entry.

    :param table: of NetworkTables, in which a robot publishes what has no other place
    """
    if name.startswith(_STATION):
        return f"{VALUE}/DS/{name.removeprefix(_STATION)}"
    if name.startswith(_NETWORK):  # a topic may have a name without a leading slash
        return VALUE + name.removeprefix(_NETWORK)
    return VALUE + table + name if name.startswith("/") else f"{VALUE}/{name}"


def _of_kit(columns: Mapping[str, Column]) -> Iterator[tuple[str, Column]]:
    """Yield what AdvantageKit or PyKit has logged of the driver station, with WPILib's names."""
    for prefix in kit_names.PREFIXES:
        for name, ours in kit_names.NAMES.items():
            if (column := columns.get(prefix + name)) is not None:
                yield ours, column
        for count, bits, ours in kit_names.BUTTONS:
            if (column := columns.get(prefix + bits)) is not None:
                yield ours, together([columns.get(prefix + count), column], kit_names.pressed)


def _fitted(columns: Mapping[str, Column]) -> Iterator[tuple[str, Column]]:
    """Yield the columns with the values that their names say, without those that have others."""
    for name, column in columns.items():
        fit = fit_of(name)
        values = [] if fit is None else [MISSING if (new := fit(value)) is None else new for value in column.values()]
        if fit is None or any(value is not MISSING for value in values):
            yield name, Column.of(column.moments, values) if values else column


def together(columns: Sequence[Column | None], make: Callable[..., Any]) -> Column:
    """Return a column that is made of the values of others whenever one of them changes.

    :param make: is passed one value of each column, None where there is none; where all are none, there is no value
    """
    moments = sorted(set().union(*(column.moments for column in columns if column is not None)))
    values = zip(*(_held(column, moments) for column in columns), strict=True)
    return Column.of(moments, [make(*each) if any(one is not None for one in each) else MISSING for each in values])


def _held(column: Column | None, moments: Iterable[int]) -> Iterator[Any]:
    """Yield a column's value at each of some moments, which are in order."""
    if column is None:
        yield from (None for _ in moments)
        return
    values, own, number = column.values(), column.moments, 0
    for moment in moments:
        while number < len(own) and own[number] <= moment:
            number += 1
        found = values[number - 1] if number else None
        yield None if found is MISSING else found


# -- the mode ---------------------------------------------------------------------------------------------------------


def _mode(columns: Mapping[str, Column]) -> Column | None:
    """Return the mode in the robot's log; where there is none, that in the driver station's log."""
    own = _robots_mode(columns)
    if _STATION_MODE[0] not in columns:
        return own
    parts = [columns.get(name) for name in _STATION_MODE]
    station = together(parts, lambda enabled, autonomous: _mode_of(enabled, autonomous, False, False))
    return station if own is None else together([own, station], lambda mode, other: other if mode is None else mode)


def _robots_mode(columns: Mapping[str, Column]) -> Column | None:
    for names in _MODES:
        if names[0] in columns:
            return together([columns.get(name) for name in names], _mode_of)
    for word in _WORDS:
        parts = [columns.get(f"{word}/{part}") for part in ("enabled", "robotMode", "eStop")]
        if parts[0] is not None:
            return together(parts, _word_mode)
    if (control := columns.get(_CONTROL)) is not None:
        flags = ENABLED, AUTONOMOUS, TEST, STOPPED
        return together([control], lambda bits: _mode_of(*(bits & flag for flag in flags)))
    return None


def _word_mode(enabled: Any, number: Any, stopped: Any) -> str:
    return mode_name(enabled and not stopped, SELECTED_BY_NUMBER.get(number, ""))


def _mode_of(enabled: Any, autonomous: Any, test: Any, stopped: Any) -> str:
    return mode_name(enabled and not stopped, selected(autonomous, test))


# -- the driver station -----------------------------------------------------------------------------------------------


def _station(columns: Mapping[str, Column]) -> Iterator[tuple[str, Column]]:
    """Yield the values of `hal_data` that the entries of a driver station are."""
    is_of_2027 = any(name in columns for name in _OF_2027)
    for stick in range(6):
        if (column := columns.get(f"DS:joystick{stick}/axes")) is not None:
            yield f"joysticks[{stick}].axes", column
        if (column := columns.get(f"DS:joystick{stick}/povs")) is not None:
            yield f"joysticks[{stick}].povs", together([column], _angles) if is_of_2027 else column
        if (column := columns.get(f"DS:joystick{stick}/buttons")) is not None:
            yield f"joysticks[{stick}].buttons", together([column], _buttons)
    for table in ("NT:/FMSInfo", "NT:/DriverStation"):  # until 2026, and from 2027 on
        if (red := columns.get(f"{table}/IsRedAlliance")) is not None:
            yield "alliance_station", together([red, columns.get(f"{table}/StationNumber")], _station_number)
    for name in ("NT:/FMSInfo/GameSpecificMessage", "NT:/DriverStation/GameData"):
        if (message := columns.get(name)) is not None:
            yield "event.game_specific_message", message


def _angles(povs: Any) -> Any:
    return tuple(_POVS.get(each, -1) for each in povs or ())


def _buttons(pressed: Any) -> Any:
    return (*(False,) * CURRENT.first_button, *(pressed or ()))


def _station_number(is_red: Any, number: Any) -> int:
    return (number or 1) + (0 if is_red else 3)


# -- the robot's place ------------------------------------------------------------------------------------------------


def _place(columns: Mapping[str, Column], height: float) -> Column | None:
    """Return the place with the most certain name of those that move; if none does, of those that are set.

    A `Field2d` that code never sets stays at 0, and one that code sets at the start alone stays there.
    """
    found = [each for each in (_place_of(columns, name) for name in columns) if each is not None]
    still = None
    for pattern in _PLACES:
        named = [each for each in found if re.fullmatch(pattern, each[0].removeprefix("NT:"), re.IGNORECASE)]
        for _, moments, read in sorted(named, key=lambda each: len(each[1]), reverse=True):
            places = {(x, y) for x, y, _ in read(0, len(moments)) if _are_numbers(x, y) and (x or y)}
            if len(places) > _PLACINGS:
                return _placed(moments, read, height)
            if places and still is None:
                still = moments, read
    return None if still is None else _placed(*still, height)


def when_of(log: ReadLog) -> datetime | None:
    """Return when the moment was that is shown as 0, if the log says so."""
    for name in CLOCKS:
        if (column := log.columns.get(name)) is not None:
            for moment, time in zip(reversed(column.moments), reversed(column.values()), strict=True):
                if isinstance(time, int) and time in TIMES:
                    return _EPOCH + timedelta(microseconds=time - moment + first_moment(log))
    try:
        return None if log.when is None else log.when + timedelta(microseconds=first_moment(log))
    except OverflowError:  # its times are damaged
        return None


def _placed(moments: array[int], read: _Read, height: float) -> Column:
    return Column(moments, lambda begin, end: [_on_field(*each, height) for each in read(begin, end)])


_Read = Callable[[int, int], Sequence[tuple[Any, Any, Any]]]


def _place_of(columns: Mapping[str, Column], name: str) -> tuple[str, array[int], _Read] | None:
    """Return a place's name, its moments, and what reads x, y and angle in metres and radians; None for others."""
    column = columns[name]
    if not column.moments or _NO_PLACE.search(name):
        return None
    whole = name.removesuffix("/translation/x")
    if whole != name:
        x, y, angle = (columns.get(f"{whole}/{part}") for part in ("translation/x", "translation/y", "rotation/value"))
        if x is None or y is None or angle is None or not x.moments == y.moments == angle.moments:
            return None
        parts = x, y, angle
        return whole, x.moments, lambda begin, end: list(zip(*(each.decode(begin, end) for each in parts), strict=True))
    if _FIELD_OBJECT.search(name) and _is_place(column.decode(0, 1)[0]):
        # As Field2d publishes it: metres and degrees.
        return name, column.moments, lambda begin, end: [_in_radians(each) for each in column.decode(begin, end)]
    return None


def _is_place(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 3 and all(isinstance(each, float) for each in value)


def _in_radians(value: Any) -> tuple[Any, Any, Any]:
    return (value[0], value[1], math.radians(value[2])) if _is_place(value) else (MISSING,) * 3


def _are_numbers(*values: Any) -> bool:
    return all(isinstance(each, (int, float)) for each in values)


def _on_field(x: Any, y: Any, angle: Any, height: float) -> Any:
    """Return a place as the field has it: feet from the top left corner, radians clockwise."""
    if not _are_numbers(x, y, angle):
        return MISSING
    return x / METRES_PER_FOOT, height - y / METRES_PER_FOOT, -angle


# -- what happened ----------------------------------------------------------------------------------------------------


def _output(columns: Mapping[str, Column]) -> Iterator[Happened]:
    for name, column in columns.items():
        if _OUTPUT.fullmatch(name):
            for moment, text in zip(column.moments, column.values(), strict=True):
                if isinstance(text, str) and text.strip():
                    yield Happened(moment / 1e6, "", text.rstrip("\n"), is_mark=True)


def _alarms(columns: Mapping[str, Column]) -> Iterator[Happened]:
    for name, text in _ALARMS.items():
        if (column := columns.get(name)) is not None:
            changes = Column.of(column.moments, column.values())
            for moment, value in zip(changes.moments, changes.values(), strict=True):
                if value in (True, 1):
                    yield Happened(moment / 1e6, "warning", text, is_mark=True)
