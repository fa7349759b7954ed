"""What a data log says of the driver station and of dashboards, as writes of input scripts."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import Any

from ...log_records import Record
from ...season import CURRENT
from ...wpi import station
from .modes import DS_ATTACHED, FMS_ATTACHED, mode_name, selected
from .network_targets import entry_target
from .targets import MODE, OPMODE, REMAINING, plugged

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

_FMS = "NT:/FMSInfo/"
#: How the names begin that have their path in `hal_data`.
HAL = "/hal_data/"
#: The entries of NetworkTables that cannot come from robot code.
FROM_OUTSIDE = re.compile(r"NT:(/.+/selected|/Preferences/[^.].*)", re.DOTALL)
#: What else is taken; the second table is that of 2027.
OF_STATION = re.compile(
    rf"DS:.+|NT:/(FMSInfo|DriverStation)/.+"
    rf"|{HAL}(control\.(dsAttached|fmsAttached|opmode)|alliance_station|event\..+|{re.escape(REMAINING)})",
    re.DOTALL,
)
_OF_STICK = re.compile(r"DS:joystick([0-5])/")

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


def target_of(record: Record) -> str:
    """Return the target of an entry of NetworkTables, whose name begins with ``NT:`` in a log."""
    return entry_target(record.name.removeprefix("NT:"), _NAMED_TYPES.get(record.type_name, ""))


def as_written(value: Any) -> Any:
    """Return a value as scripts have it."""
    return list(value) if isinstance(value, tuple) else value


@dataclass
class LoggedInputs:
    """The latest values of a log, and what was written of them.

    :param given: the names of further entries of NetworkTables that are inputs
    :param is_simulation: whether the log has what was written to NetworkTables from outside
    :param written_outside: the names of the entries that were written to, in the form that they have in the log
    """

    given: Collection[str] = ()
    is_simulation: bool = False
    written_outside: Collection[str] = ()
    _sent: dict[str, Any] = field(default_factory=dict)
    #: The joysticks of which something was logged since their changes were returned.
    _moved: set[int] = field(default_factory=set)
    _fms: dict[str, Any] = field(default_factory=dict)
    _hal: dict[str, Any] = field(default_factory=dict)
    #: Values that are written to NetworkTables, by target.
    _from_outside: dict[str, Any] = field(default_factory=dict)
    _written: dict[str, Any] = field(default_factory=dict)

    def take(self, record: Record) -> None:
        """Take a value of the log."""
        name, value = record.name, record.value
        if name.startswith("DS:"):
            self._sent[name.removeprefix("DS:")] = value
            if (stick := _OF_STICK.match(name)) is not None:
                self._moved.add(int(stick[1]))
        elif name.startswith(HAL):
            self._hal[name.removeprefix(HAL)] = value
        elif name.startswith(_FMS):
            self._fms[name.removeprefix(_FMS)] = value
        if self._is_from_outside(name):
            self._from_outside[target_of(record)] = as_written(value)

    def changes(self) -> Iterator[tuple[str, Any]]:
        """Return what to write: nothing but the lost connection while no driver station is attached."""
        attached = self._attached()
        yield from self._changed("control.dsAttached", attached, True)
        if attached:
            for target, value, initially in self._station():
                yield from self._changed(target, value, initially)
            for stick in sorted(self._moved):
                yield from self._joystick(stick)
            self._moved.clear()
        for target, value in self._from_outside.items():
            yield from self._changed(target, value, None)

    def _is_from_outside(self, name: str) -> bool:
        if name in self.written_outside:
            return False
        return name in self.given or (not self.is_simulation and bool(FROM_OUTSIDE.fullmatch(name)))

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
        place = fms.get("StationNumber", 1) + (0 if fms.get("IsRedAlliance", True) else 3)
        yield "alliance_station", _STATIONS[ours.get("alliance_station", place)], "red1"
        yield "control.eStop", bool(self._sent.get("estop")), False
        fms_attached = bool(ours.get("control.fmsAttached", fms.get("FMSControlData", 0) & FMS_ATTACHED))
        yield "control.fmsAttached", fms_attached, False
        name = ours.get("event.name", fms.get("EventName", station.EVENT_NAME))
        yield "event.name", _as_sent(name), station.EVENT_NAME
        yield "event.match_number", ours.get("event.match_number", fms.get("MatchNumber", 0)), 0
        yield "event.match_type", _MATCH_TYPES[ours.get("event.match_type", fms.get("MatchType", 0))], "none"
        message = ours.get("event.game_specific_message", fms.get("GameSpecificMessage", ""))
        yield "event.game_specific_message", _as_sent(message), ""
        if (left := ours.get(REMAINING)) is not None:
            yield REMAINING, left, 0.0
        if CURRENT.opmodes:
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
