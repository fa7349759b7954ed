"""Convert rows of the device tables to live values, and say what each value is.

A field with a WPILib name such as `Speed` is read, written and watched by the functions of its `*Sim` object whose
names follow from it (`accessors`). A field without a WPILib name does not exist in the current HAL: it is stored as
written, so that older tests still work.

Everything that treats a value in a special way asks its row (`rows`): recordings, restarts, comparisons, the fuzzer,
logs, physics and the simulator. The tables import no WPILib until a device is made, since the simulator's window asks
them, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from operator import attrgetter
from typing import Any, Literal

from . import accessors
from .containers import LiveDict, LiveList, Slot, stored
from .kinds import ANY, BOOL, ValueKind
from .paths import join

#: What robot code finds there: ``input``, what the driver station sends; ``measured``, what a sensor measures;
#: ``output``, what robot code sets. Empty: a setting, or another form of such a value.
Role = Literal["", "input", "measured", "output"]

_Switched = Literal["switch", "pulses", "connected", "option"]
_Electric = Literal["volts", "battery", "rail", "amperes"]
_Angle = Literal["angle", "half turns", "heading", "turns", "radians", "rotations"]
_Speed = Literal["rate", "turning", "radians per second", "rpm"]
_Moved = Literal["acceleration", "m/s2", "range"]
#: What a sensor measures, with the range and the unit of the real thing: see `fuzz.inputs.values.SPANS`.
Quantity = Literal[_Switched, _Electric, _Angle, _Speed, _Moved, "count", "celsius", "hertz", "whole"]

#: How the simulator shows a value. Outputs: ``meter`` (a bar from its range's middle, or from 0), ``lamp``, ``lamps``,
#: ``relay``, ``bars``, ``leds``, ``text``. Inputs: ``switch``, ``slider`` and ``number``, which can be set.
RowKind = Literal["meter", "lamp", "lamps", "relay", "bars", "leds", "text", "switch", "slider", "number"]


@dataclass(frozen=True)
class Shown:
    """How the simulator shows a value.

    :param label: ``{}`` stands for the device's number, with the team's label
    :param tooltip: ``{}`` stands for the name of the device, ``{key}`` for the device's value of that key
    :param low: the lowest value of a meter or slider; `high` likewise
    :param also: the keys of the values that are shown in the same row
    """

    kind: RowKind
    label: str = "{}"
    tooltip: str = ""
    low: float = 0.0
    high: float = 1.0
    decimals: int = 2
    unit: str = ""
    also: tuple[str, ...] = ()


@dataclass(frozen=True)
class DeviceField:
    """One value of a device.

    :param name: its key in `hal_data`
    :param hal: WPILib's name for it; None where the current HAL lacks it, and `default` is stored instead
    :param kind: the check of values that are written
    :param default: the initial value where the HAL lacks it
    :param same_as: the field of which this is an alias, with the same listeners
    :param recorded: False for a value that is constant, or can be derived from others
    :param unset: for an output of the robot: the value in the HAL when a test writes None
    :param get: reads from the `*Sim` object, where that differs from WPILib's method
    :param put: writes to the `*Sim` object, where that differs from WPILib's method
    :param role: whether robot code reads or sets it
    :param only_if: the key of the value that says whether it is measured; if not, it is an output
    :param quantity: what is measured; empty for what follows from other values, which `pyfrc fuzz` does not vary
    :param asked_by: the function with which robot code asks for it, if it is varied only for code that does
    :param called: what people call it, if that is not its path
    :param shown: how the simulator shows it; None: not at all
    :param stays: whether a restart of the robot program leaves it; None: as its kind says
    :param heading: the change for each degree that the robot turns clockwise; 0 if it is no gyro's angle
    :param turning: the value for each degree per second that it turns clockwise; 0 if it is no gyro's rate
    :param stopped: the key of the value that is 0 while this one is infinite, which JSON lacks
    :param length: how many values it has, if it is a list
    :param off: for an output that the hardware of a disabled robot turns off: its value then
    """

    name: str
    hal: str | None = None
    kind: ValueKind = ANY
    default: Any = None
    same_as: str = ""
    recorded: bool = True
    unset: Any = None
    get: Callable[[Any], Any] | None = None
    put: Callable[[Any, Any], object] | None = None
    role: Role = ""
    only_if: str = ""
    quantity: Quantity | Literal[""] = ""
    asked_by: str = ""
    called: str = ""
    shown: Shown | None = None
    stays: bool | None = None
    heading: float = 0.0
    turning: float = 0.0
    stopped: str = ""
    length: int = 0
    off: Any = None

    def slot(self, device: object) -> Slot:
        """Return the access to this field of `device`; None stands for a channel that the HAL does not have."""
        if device is None or (self.hal is None and self.get is None):
            return stored(self.kind.default if self.default is None else self.default)
        raw = get = partial(self.get, device) if self.get else accessors.getter(device, self.hal)
        if self.kind.load is not None:
            get = _converted(raw, self.kind.load)
        read_plain = None if self.kind.plain is None else _converted(raw, self.kind.plain)
        put = partial(self.put, device) if self.put else accessors.setter(device, self.hal)
        register = accessors.registrar(device, self.hal)
        watch = None if register is None else partial(_watch, register)
        name = self.same_as or self.name
        return Slot(get, put, self.kind, watch, name, self.recorded, unset=self.unset, plain=read_plain)


def _converted(get: Callable[[], object], convert: Callable[[Any], object]) -> Callable[[], Any]:
    return lambda: convert(get())


def _watch(register: Callable[..., object], fire: Callable[[], None]) -> object:
    return register(lambda *_: fire(), False)


def named(name: str, module: str = "wpilib.simulation") -> Any:
    """Return what has this name in a module, which is imported only now."""
    return attrgetter(name)(import_module(module))


def later(name: str, module: str = "wpilib.simulation") -> Callable[..., Any]:
    """Return a function that calls the one of this name, and imports its module only then."""
    return lambda *args: named(name, module)(*args)


Input = partial(DeviceField, role="input")
Output = partial(DeviceField, role="output")
Measured = partial(DeviceField, role="measured")

INITIALIZED = DeviceField("initialized", "Initialized", BOOL, recorded=False)
HAS_SOURCE = DeviceField("has_source", default=False)


@dataclass(frozen=True)
class DeviceKind:
    """The devices of one kind.

    :param name: its key in `hal_data`; empty: its values have keys of their own
    :param fields: the fields of each device
    :param make: returns WPILib's object for an index; without an argument, if there is only one
    :param count: how many there are; None: one without a number
    :param real: how many of them the HAL has; the others are stored values
    :param exists: the key of the value that says whether robot code has made it; empty: it exists in any case
    :param build: returns its part of `hal_data`, if that needs more than `fields`
    :param by_number: for modules on the CAN bus, which appear when robot code makes them
    :param config: returns the read-only value at ``config``, for kinds that have one
    :param wired_to: the kind of the channels that it uses: those of `config`, or the one with its own number
    :param is_on: returns whether a device is to be turned off while the robot is disabled, from its values
    :param seldom: whether `pyfrc fuzz` changes it less often than other sensors
    :param stays: whether a restart of the robot program leaves it: the driver station sends it again
    :param title: what people call one
    :param panel: the title of the simulator's panel that shows it
    :param labels: the part of ``sim/config.json`` with the team's labels for the numbers
    """

    name: str
    fields: tuple[DeviceField, ...]
    make: Callable[..., Any] | None = None
    count: int | None = None
    real: int = 64
    exists: str = "initialized"
    build: Callable[[], Any] | None = None
    by_number: bool = False
    config: Callable[[int], Any] | None = None
    wired_to: str = ""
    is_on: Callable[[LiveDict], bool] = lambda device: True
    seldom: bool = False
    stays: bool = False
    title: str = ""
    panel: str = ""
    labels: str = ""

    def slots(self, index: int | None = None) -> dict[str, Slot]:
        """Return the access to the values of one device."""
        numbers = () if index is None else (index,)
        device = self.make(*numbers) if self.make and (index or 0) < self.real else None
        slots = {field.name: field.slot(device) for field in self.fields}
        if self.config is not None:
            slots["config"] = Slot(partial(self.config, *numbers), None, recorded=False, remedy="the robot sets it")
        return slots

    def branch(self) -> LiveDict | LiveList:
        """Return its part of `hal_data`."""
        if self.build is not None:
            built: LiveDict | LiveList = self.build()
            return built
        if self.count is None:
            return LiveDict(self.name, self.slots)
        paths = [join(self.name, index) for index in range(self.count)]
        return LiveList(self.name, [LiveDict(path, partial(self.slots, index)) for index, path in enumerate(paths)])

    def initialized(self) -> list[Slot]:
        """Return a slot for each device of the HAL that says whether the robot has created it."""
        if self.make is None or not self.exists:
            return []
        exists = next(field for field in self.fields if field.name == self.exists)
        numbers = [()] if self.count is None else [(index,) for index in range(min(self.count, self.real))]
        return [exists.slot(self.make(*number)) for number in numbers]


def group(path: str, device: object, fields: tuple[DeviceField, ...]) -> LiveDict:
    """Return the dict of one device."""
    return LiveDict(path, lambda: {field.name: field.slot(device) for field in fields})
