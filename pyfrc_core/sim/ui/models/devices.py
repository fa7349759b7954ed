"""The rows of the device panels, made from a snapshot's values.

How a device is shown is in its row of the device table (`hal.fields.Shown`); SimDevices, which have no rows, are shown
by functions here. Only a new `RowKind` needs a change elsewhere: a class in `ITEMS` of `tk.device_items`, which draws
it, and for an input the mouse in `tk.device_view`.

The values contain only devices that the robot has made, so only these have rows. `DeviceRows` makes the rows again when
a device comes or goes; otherwise only the values at their paths change.

Of vendors' devices on the CAN bus, REV's SPARKs and CTRE's devices of phoenix6 are known. A SPARK's ``Setpoint`` is a
power only in one of its control modes, so its row names the mode and the unit.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from ....hal import device_table
from ....hal.fields import DeviceField, DeviceKind, RowKind
from ....hal.paths import parse_path
from ....hal.rows import decides
from ....season import CURRENT

if TYPE_CHECKING:
    from ....config.sim import SimConfig

#: The kinds of inputs, which the user can set.
SETTABLE = frozenset({"switch", "slider", "number"})

#: Names of values that are angles in degrees.
_ANGLE = re.compile("angle|yaw", re.IGNORECASE)

#: What shows a value that cannot be set, in place of what sets it.
_UNSETTABLE: Mapping[RowKind, RowKind] = {"switch": "lamp", "slider": "meter", "number": "text"}

_GYROS, _SIM_DEVICES, _OTHERS, _CUSTOM = "Gyros", "CAN and SimDevices", "Other values", "Custom"
#: The panels in their order on the screen; further ones of the device table come last.
_PANELS = (
    "PWM",
    "Digital I/O",
    "Analog inputs",
    "Analog outputs",
    "Relays",
    "Pneumatics",
    "Encoders and counters",
    _GYROS,
    _SIM_DEVICES,
    "Power",
    CURRENT.controller.name,
    _OTHERS,
    _CUSTOM,
)

Values = Mapping[str, Any]


@dataclass(frozen=True)
class Row:
    """One device's line.

    :param paths: the paths of its values: one, a relay's two directions, or one for each of a module's lamps
    :param low: the lowest value of a meter or slider; `high` likewise
    :param tooltip: an explanation of the row
    """

    kind: RowKind
    paths: tuple[str, ...]
    label: str
    low: float = 0.0
    high: float = 1.0
    decimals: int = 2
    unit: str = ""
    tooltip: str = ""


@dataclass(frozen=True)
class Panel:
    """Devices of one kind."""

    title: str
    rows: tuple[Row, ...]


class DeviceRows:
    """The panels of one robot.

    :param config: names its channels
    """

    def __init__(self, config: SimConfig) -> None:
        self._config = config
        self._paths: frozenset[str] = frozenset()
        self._decisive: list[str] = []
        self._shape: object = None
        self.panels: tuple[Panel, ...] = ()

    def update(self, values: Values) -> bool:
        """Make the panels for these values, and return whether they have changed."""
        # A robot may use a channel as an input and later as an output, and a motor controller in several modes.
        is_known = values.keys() == self._paths
        if not is_known:
            self._paths = frozenset(values)
            self._decisive = [path for path in values if decides(path) or changes_rows(path)]
        shape = [values[path] for path in self._decisive]
        if is_known and shape == self._shape:
            return False
        self._shape = shape
        before, self.panels = self.panels, tuple(panels_of(values, self._config))
        return self.panels != before


def panels_of(values: Values, config: SimConfig) -> Iterator[Panel]:
    """Yield the panels that have rows, in their order on the screen."""
    tree = _tree(values)
    panels: dict[str, list[Row]] = {title: [] for title in _PANELS}
    for kind in device_table.KINDS:
        panels.setdefault(kind.panel or _OTHERS, []).extend(_rows_of(kind, tree, config))
    for title, make in ((_GYROS, _gyros), (_SIM_DEVICES, _sim_devices), (_OTHERS, _robot), (_CUSTOM, _custom)):
        panels[title] += make(tree, config)
    yield from (Panel(title, tuple(rows)) for title, rows in panels.items() if rows)


def _tree(values: Values) -> dict[Any, Any]:
    """Return the values as a tree, by the segments of their paths."""
    tree: dict[Any, Any] = {}
    for path, value in values.items():
        place = tree
        try:
            *parents, last = parse_path(path)
        except ValueError:  # a user's key that cannot be written as a path
            continue
        for segment in parents:
            place = place.setdefault(segment, {})
        place[last] = path, value
    return tree


def _rows_of(kind: DeviceKind, tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    """Yield the rows of the devices of one kind."""
    shown = [field for field in kind.fields if field.shown is not None]
    branch = tree.get(kind.name, {}) if kind.name else tree
    devices = sorted(branch.items()) if kind.count is not None or kind.by_number else [("", branch)]
    labels: Mapping[Any, str] = getattr(config, kind.labels) if kind.labels else {}
    for number, fields in devices if shown else ():
        for field in shown:
            yield from _row_of(kind, field, number, fields, labels)


def _row_of(
    kind: DeviceKind, field: DeviceField, number: Any, fields: Mapping[Any, Any], labels: Mapping[Any, str]
) -> Iterator[Row]:
    """Yield the row of one value of a device, if it has it.

    :param fields: the path and value of each of the device's values; of a pneumatics module, those of each channel
    :param labels: the team's labels by number, or of a module by channel
    """
    shown = field.shown
    assert shown is not None
    row_kind, label = shown.kind, labels.get(number, "")
    if row_kind == "lamps":
        paths = [values[field.name][0] for _, values in sorted(fields.items()) if field.name in values]
        named = ", ".join(f"{channel} {each}" for channel, each in sorted(labels.items()))
        label, tooltip = "", shown.tooltip + (f": {named}" if named else "").replace("{", "{{").replace("}", "}}")
    else:
        paths = [fields[name][0] for name in (field.name, *shown.also) if name in fields]
        tooltip = shown.tooltip
    if len(paths) <= len(shown.also):
        return
    if field.only_if and not fields.get(field.only_if, ("", True))[1]:
        row_kind, tooltip = _UNSETTABLE[row_kind], "{}: an output of the robot"
    values = {each.name: fields[each.name][1] if each.name in fields else each.default for each in kind.fields}
    # The panel may have no space for the whole label.
    name = f"{kind.title} {number}".strip() + (f", {label}" if label else "")
    yield Row(
        row_kind,
        tuple(paths),
        shown.label.format(f"{number}  {label}" if label else number),
        shown.low,
        shown.high,
        shown.decimals,
        shown.unit,
        tooltip.format(name, **values),
    )


def _is_gyro(device: object) -> bool:
    return str(device).startswith(("Gyro:", "CANGyro:")) or "navx" in str(device).lower()


def _gyros(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    for device, fields in tree.get("CAN", {}).items():
        if _is_gyro(device):
            name = device_name(str(device))
            yield from _device_rows(str(device), fields, name.partition(":")[2] or name)


def _sim_devices(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    for device, fields in tree.get("CAN", {}).items():
        if not _is_gyro(device):
            number = re.search(r"\[(?:\d+,\s*)?(\d+)\]$", str(device))
            label = config.CAN.get(int(number[1]), "") if number and not str(device).startswith("DutyCycle") else ""
            title = f"{device_name(str(device))}  {label}".strip()
            yield from _device_rows(str(device), fields, title, set_point(str(device), tree["CAN"]))


def _device_rows(device: str, fields: Mapping[Any, Any], title: str, setting: SetPoint | None = None) -> Iterator[Row]:
    yield Row("text", (), title, tooltip=f"The simulated device {device}")
    for name, (path, value) in fields.items():
        text, tooltip = f"   {str(name).strip()}", f"{name} of {device}"
        if isinstance(value, bool):
            yield Row("switch", (path,), text, tooltip=f"{tooltip}: click to change it")
        elif setting is not None and name == "Setpoint":
            what = f"{tooltip}: {setting}. The robot has set it"
            yield Row("number", (path,), f"   Setpoint ({setting.mode})", unit=setting.unit, tooltip=what)
        elif name in OUTPUTS:
            yield Row("meter", (path,), text, -1.0, 1.0, 2, "", f"{tooltip}: what drives the motor, from -1 to 1")
        elif isinstance(value, int | float) and _ANGLE.search(str(name)):
            yield Row("slider", (path,), text, -360.0, 360.0, 1, "°", tooltip)
        elif isinstance(value, int | float):
            decimals = 0 if isinstance(value, int) else 2
            tooltip = f"{tooltip}: click the number to change it"
            yield Row("number", (path,), text, decimals=decimals, unit=unit_of(str(name)), tooltip=tooltip)
        else:
            yield Row("text", (path,), text, tooltip=tooltip)


def _robot(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    for name, (path, value) in tree.get("robot", {}).items():
        kind: RowKind = "switch" if isinstance(value, bool) else "number" if isinstance(value, int | float) else "text"
        yield Row(
            kind,
            (path,),
            str(name),
            tooltip=f"hal_data['robot']['{name}']: the value that this device reports to the robot",
        )


def _custom(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    for name, entry in tree.get("custom", {}).items():
        # Robot code may write a dict or list there.
        if isinstance(entry, tuple):
            yield Row("text", (entry[0],), str(name), tooltip=f"hal_data['custom']['{name}']")


_SPARK = re.compile(r"SPARK (MAX|Flex) \[[\d,]+\]")
_PHOENIX = re.compile(r"CAN\w*:(?P<kind>[^/\[\]]+?) \(v6\)\[(?P<number>\d+)\](?:/(?P<part>.+))?")

#: REV's control modes by the number in ``Control Mode``, each with the unit of its set-point.
_MODES = {
    0: ("duty cycle", ""),
    1: ("velocity", "velocity"),
    2: ("voltage", "V"),
    3: ("position", "position"),
    4: ("current", "A"),
    5: ("MAXMotion position", "position"),
    6: ("MAXMotion velocity", "velocity"),
}
#: The units of a SPARK's encoder if the robot has not changed its conversion factor.
_PLAIN_UNITS = {"velocity": "rpm", "position": "turns"}

#: The values that are an output from -1 to 1.
OUTPUTS = frozenset({"Applied Output", "dutyCycle"})

_UNITS = {
    "Bus Voltage": "V",
    "Motor Current": "A",
    "Motor Temperature": "°C",
    "Voltage": "V",
    "motorVoltage": "V",
    "supplyVoltage": "V",
    "supplyCurrent": "A",
    "torqueCurrent": "A",
}


class SetPoint(NamedTuple):
    """The set-point of a SPARK: its mode, and its unit, which is empty for the units of the robot's code."""

    mode: str
    unit: str

    def __str__(self) -> str:
        plain = "from -1 to 1" if self.mode == "duty cycle" else "in the units of the robot's code"
        return f"{self.mode}, {f'in {self.unit}' if self.unit else plain}"


def device_name(device: str) -> str:
    """Return the name that people know: ``Talon FX [3]`` for ``CANMotor:Talon FX (v6)[3]``."""
    match = _PHOENIX.fullmatch(device)
    return f"{match['kind']} [{match['number']}] {match['part'] or ''}".strip() if match else device


def set_point(device: str, devices: Mapping[Any, Mapping[Any, tuple[str, Any]]]) -> SetPoint | None:
    """Return the mode of a SPARK's set-point; None for other devices.

    :param devices: the path and value of each value, by device and name
    """
    if not _SPARK.fullmatch(device) or "Control Mode" not in devices[device]:
        return None
    mode, unit = _MODES.get(devices[device]["Control Mode"][1], ("unknown mode", ""))
    if unit in _PLAIN_UNITS:
        encoder = devices.get(f"{device} RELATIVE ENCODER", {})
        _, factor = encoder.get(f"{unit.capitalize()} Conversion Factor", ("", 1.0))
        unit = _PLAIN_UNITS[unit] if math.isclose(factor, 1.0) else ""
    return SetPoint(mode, unit)


def unit_of(name: str) -> str:
    """Return the unit of a value, by its name; empty if it is not known."""
    return _UNITS.get(name, "")


def changes_rows(path: str) -> bool:
    """Return whether a change of this value changes labels or units."""
    return path.endswith(('["Control Mode"]', 'Conversion Factor"]'))
