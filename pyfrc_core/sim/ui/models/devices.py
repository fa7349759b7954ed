"""The rows of the device panels, made from a snapshot's values.

A device gets its rows from a function in `panels_of`. Only a new `RowKind` needs a change elsewhere: a class in
`ITEMS` of `tk.device_items`, which draws it, and for an input the mouse in `tk.device_view`.

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
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from ....hal.paths import parse_path
from ....season import CURRENT

if TYPE_CHECKING:
    from ....config.sim import SimConfig

#: How a row is shown. Outputs: ``meter`` (a bar from its range's middle, or from 0), ``lamp``, ``lamps``, ``relay``,
#: ``bars``, ``leds``, ``text``. Inputs: ``switch``, ``slider`` and ``number``, which can be set.
RowKind = Literal["meter", "lamp", "lamps", "relay", "bars", "leds", "text", "switch", "slider", "number"]

#: The kinds of inputs, which the user can set.
SETTABLE = frozenset({"switch", "slider", "number"})

#: Names of values that are angles in degrees.
_ANGLE = re.compile("angle|yaw", re.IGNORECASE)

_INPUT = "an input, click to change it"

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
            self._decisive = [path for path in values if path.endswith(".is_input") or changes_rows(path)]
        shape = [values[path] for path in self._decisive]
        if is_known and shape == self._shape:
            return False
        self._shape = shape
        before, self.panels = self.panels, tuple(panels_of(values, self._config))
        return self.panels != before


def panels_of(values: Values, config: SimConfig) -> Iterator[Panel]:
    """Yield the panels that have rows, in their order on the screen."""
    tree = _tree(values)
    makers = {
        "PWM": _pwm,
        "Digital I/O": _dio,
        "Analog inputs": _analog_in,
        "Analog outputs": _analog_out,
        "Relays": _relays,
        "Pneumatics": _pneumatics,
        "Encoders and counters": _encoders,
        "Gyros": _gyros,
        "CAN and SimDevices": _sim_devices,
        "Power": _power,
        CURRENT.controller.name: _controller,
        "Other values": _robot,
        "Custom": _custom,
    }
    for title, make in makers.items():
        if rows := tuple(make(tree, config)):
            yield Panel(title, rows)


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


def _named(channel: int | str, labels: Mapping[int, str]) -> str:
    label = labels.get(channel, "") if isinstance(channel, int) else ""
    return f"{channel}  {label}" if label else f"{channel}"


def _titled(what: str, channel: int, labels: Mapping[int, str]) -> str:
    """Return the name with the whole label, for which the panel may have no space."""
    return f"{what} {channel}, {labels[channel]}" if channel in labels else f"{what} {channel}"


def _channels(tree: dict[Any, Any], key: str) -> Iterator[tuple[int, dict[Any, Any]]]:
    yield from sorted(tree.get(key, {}).items())


def _pwm(tree: dict[object, object], config: SimConfig) -> Iterator[Row]:
    for channel, fields in _channels(tree, "pwm"):
        if "value" in fields:
            what = f"{_titled('PWM', channel, config.pwm)}: what the robot sends to the motor, from -1 to 1"
            yield Row("meter", (fields["value"][0],), _named(channel, config.pwm), -1.0, 1.0, 2, "", what)
    for channel, fields in _channels(tree, "d0_pwm"):
        if "duty_cycle" in fields:
            yield Row("meter", (fields["duty_cycle"][0],), f"{channel}  (DIO as PWM)", tooltip="Its duty cycle, 0 to 1")


def _dio(tree: dict[object, object], config: SimConfig) -> Iterator[Row]:
    for channel, fields in _channels(tree, "dio"):
        if "value" not in fields:
            continue
        is_input = "is_input" in fields and fields["is_input"][1]
        kind: RowKind = "switch" if is_input else "lamp"
        what = f"{_titled('DIO', channel, config.dio)}: {_INPUT if is_input else 'an output of the robot'}"
        yield Row(kind, (fields["value"][0],), _named(channel, config.dio), tooltip=what)
    for channel, fields in _channels(tree, "duty_cycle"):
        if "output" in fields:
            what = "The duty cycle that the robot measures"
            yield Row("slider", (fields["output"][0],), f"Duty cycle {channel}", tooltip=what)


def _analog_in(tree: dict[object, object], config: SimConfig) -> Iterator[Row]:
    for channel, fields in _channels(tree, "analog_in"):
        if "voltage" in fields:
            what = f"{_titled('Analog input', channel, config.analog)}: the voltage that the robot measures"
            highest = CURRENT.controller.analog_volts
            yield Row("slider", (fields["voltage"][0],), _named(channel, config.analog), 0.0, highest, 2, "V", what)


def _analog_out(tree: dict[object, object], config: SimConfig) -> Iterator[Row]:
    for channel, fields in _channels(tree, "analog_out"):
        if "voltage" in fields:
            what = f"Analog output {channel}: the voltage that the robot puts out"
            yield Row("meter", (fields["voltage"][0],), f"{channel}", 0.0, 5.0, 2, "V", what)


def _relays(tree: dict[object, object], config: SimConfig) -> Iterator[Row]:
    for channel, fields in _channels(tree, "relay"):
        if {"fwd", "rev"} <= fields.keys():
            paths = fields["fwd"][0], fields["rev"][0]
            what = f"{_titled('Relay', channel, config.relay)}: its two directions"
            yield Row("relay", paths, _named(channel, config.relay), tooltip=what)


def _pneumatics(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    for key, name in (("pcm", "PCM"), ("ph", "PH")):
        for module, solenoids in _channels(tree, key):
            paths = tuple(fields["value"][0] for _, fields in sorted(solenoids.items()) if "value" in fields)
            labels = ", ".join(f"{channel} {label}" for channel, label in sorted(config.solenoid.items()))
            what = f"The solenoids of {name} {module}, from 0" + (f": {labels}" if labels else "")
            yield Row("lamps", paths, f"{name} {module}", tooltip=what)
            compressor = tree.get(f"{key}_compressor", {}).get(module, {})
            if "on" in compressor:
                yield Row(
                    "lamp", (compressor["on"][0],), "   Compressor", tooltip=f"Of {name} {module}: whether it runs"
                )
            if "pressure_switch" in compressor:
                what = f"Of {name} {module}: whether the pressure is high enough"
                yield Row("switch", (compressor["pressure_switch"][0],), "   Pressure switch", tooltip=what)


def _encoders(tree: dict[object, object], config: SimConfig) -> Iterator[Row]:
    for number, fields in _channels(tree, "encoder"):
        if "count" in fields:
            each = fields.get("distance_per_pulse", ("", 1.0))[1]
            what = f"Encoder {number}: its counts, of {each:g} distance units each. Click the number to change it"
            yield Row("number", (fields["count"][0],), f"Encoder {number}", decimals=0, tooltip=what)
    for number, fields in _channels(tree, "counter"):
        if "count" in fields:
            what = f"Counter {number}: its counts. Click the number to change it"
            yield Row("number", (fields["count"][0],), f"Counter {number}", decimals=0, tooltip=what)


def _is_gyro(device: object) -> bool:
    return str(device).startswith(("Gyro:", "CANGyro:")) or "navx" in str(device).lower()


#: The units of the values of the controller's IMU, by their names without the axis.
_IMU_UNITS = {"yaw": "rad", "angle_": "rad", "gyro_rate_": "rad/s", "accel_": "m/s²"}


def _gyros(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    for channel, fields in _channels(tree, "analog_gyro"):
        if "angle" in fields:
            what = f"The gyro at analog input {channel}: degrees clockwise"
            yield Row("slider", (fields["angle"][0],), f"Analog {channel}", -360.0, 360.0, 1, "°", what)
    for name, (path, _) in tree.get("onboard_imu", {}).items():
        if unit := _IMU_UNITS.get(name.rstrip("xyz")):
            what = f"The IMU in the {CURRENT.controller.name}"
            yield Row("number", (path,), name.replace("_", " ").capitalize(), unit=unit, tooltip=what)
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


def _power(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    power = tree.get("power", {})
    if "vin_voltage" in power:
        what = f"The voltage that the {CURRENT.controller.name} gets from the battery"
        yield Row("slider", (power["vin_voltage"][0],), "Battery", 0.0, 14.0, 2, "V", what)
    for module, fields in _channels(tree, "pdp"):
        if "voltage" in fields:
            what = f"Power distribution {module}: its voltage"
            yield Row("slider", (fields["voltage"][0],), f"PDP {module}", 0.0, 14.0, 2, "V", what)
        if "current" in fields:
            what = f"Power distribution {module}: the current of each channel, up to 40 A"
            yield Row("bars", (fields["current"][0],), "   Currents", 0.0, 40.0, 1, "A", what)


def _controller(tree: dict[Any, Any], config: SimConfig) -> Iterator[Row]:
    if "fpga_button" in tree:
        yield Row("switch", (tree["fpga_button"][0],), "User button", tooltip="The button on the roboRIO")
    accelerometer = tree.get("accelerometer", {})
    for axis in "xyz":
        if axis in accelerometer:
            what = f"The accelerometer in the roboRIO, along {axis}"
            yield Row("slider", (accelerometer[axis][0],), f"Accelerometer {axis}", -8.0, 8.0, 2, "g", what)
    for number, fields in _channels(tree, "addressable_led"):
        if "data" in fields:
            yield Row("leds", (fields["data"][0],), f"LEDs {number}", tooltip="The colours of the LED strip")


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
