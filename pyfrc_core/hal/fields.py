"""Convert rows of the device tables to live values.

A field with a WPILib name such as `Speed` is read, written and watched by the functions of its `*Sim` object whose
names follow from it (`accessors`). A field without a WPILib name does not exist in the current HAL: it is stored as
written, so that older tests still work.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from . import accessors
from .containers import LiveDict, LiveList, Slot, stored
from .kinds import ANY, BOOL, ValueKind
from .paths import join


@dataclass(frozen=True)
class DeviceField:
    """One value of a device.

    :param name: its key in `hal_data`
    :param hal: WPILib's name for it; None where the current HAL lacks it, and `default` is stored instead
    :param kind: the check of values that are written
    :param default: the initial value where the HAL lacks it
    :param same_as: the field of which this is an alias, with the same listeners
    :param recorded: False for a value that can be derived from others
    :param unset: for an output of the robot: the value in the HAL when a test writes None
    :param get: reads from the `*Sim` object, where that differs from WPILib's method
    :param put: writes to the `*Sim` object, where that differs from WPILib's method
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


INITIALIZED = DeviceField("initialized", "Initialized", BOOL, recorded=False)
HAS_SOURCE = DeviceField("has_source", default=False)


@dataclass(frozen=True)
class DeviceKind:
    """A list of devices of one kind.

    :param name: its key in `hal_data`
    :param count: the length of the list
    :param make: returns WPILib's object for an index
    :param fields: the fields of each device
    :param real: how many of them the HAL has; the others are stored values
    :param config: returns the read-only value at ``config``, for kinds that have one
    """

    name: str
    count: int
    make: Callable[[int], Any] | None
    fields: tuple[DeviceField, ...]
    real: int = 64
    config: Callable[[int], Any] | None = None

    def device(self, path: str, index: int) -> LiveDict:
        def build() -> dict[str, Slot]:
            device = self.make(index) if self.make and index < self.real else None
            slots = {field.name: field.slot(device) for field in self.fields}
            if self.config is not None:
                slots["config"] = Slot(partial(self.config, index), None, recorded=False, remedy="the robot sets it")
            return slots

        return LiveDict(path, build)

    def devices(self) -> LiveList:
        return LiveList(self.name, [self.device(join(self.name, i), i) for i in range(self.count)])

    def initialized(self) -> list[Slot]:
        """Return a slot for each device of the HAL that says whether the robot has created it."""
        if self.make is None:
            return []
        initialized = next(field for field in self.fields if field.name == "initialized")
        return [initialized.slot(self.make(i)) for i in range(min(self.count, self.real))]


def group(path: str, device: object, fields: tuple[DeviceField, ...]) -> LiveDict:
    """Return one dict for a device that exists only once."""
    return LiveDict(path, lambda: {field.name: field.slot(device) for field in fields})
