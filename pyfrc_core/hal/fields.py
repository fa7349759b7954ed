"""How a row of the device tables becomes a live value.

A field with a WPILib name `Speed` is read by ``getSpeed``, written by ``setSpeed`` and watched by
``registerSpeedCallback`` of the `*Sim` object it is bound to. A field without one is not known to today's
HAL: it is kept as written, so that older tests still work.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from .containers import LiveDict, LiveList, Slot, kept
from .kinds import ANY, BOOL, Kind
from .paths import join


@dataclass(frozen=True)
class Field:
    """One value of a device.

    :param hal:      WPILib's name for it; None where today's HAL lacks it and `default` is kept instead
    :param same_as:  the field of which this is another name: it shares the listeners
    :param recorded: False for a value that follows from others
    :param unset:    of an output of the robot: what the HAL gets when a test writes None
    :param get, put: the access from and to the `*Sim` object where it is not WPILib's own
    """

    name: str
    hal: str | None = None
    kind: Kind = ANY
    default: Any = None
    same_as: str = ""
    recorded: bool = True
    unset: Any = None
    get: Callable[[Any], Any] | None = None
    put: Callable[[Any, Any], object] | None = None

    def slot(self, device: Any) -> Slot:
        """The access to this field of `device`; None stands for a channel that the HAL does not have."""
        if device is None or (self.hal is None and self.get is None):
            return kept(self.kind.default if self.default is None else self.default)
        get = partial(self.get, device) if self.get else getattr(device, f"get{self.hal}")
        if self.kind.load is not None:
            get = _loaded(get, self.kind.load)
        put = partial(self.put, device) if self.put else getattr(device, f"set{self.hal}", None)
        register = getattr(device, f"register{self.hal}Callback", None)
        watch = None if register is None else partial(_watch, register)
        return Slot(get, put, self.kind, watch, self.same_as or self.name, self.recorded, unset=self.unset)


def _loaded(get: Callable[[], Any], load: Callable[[Any], Any]) -> Callable[[], Any]:
    return lambda: load(get())


def _watch(register: Callable[..., object], fire: Callable[[], None]) -> object:
    return register(lambda *_: fire(), False)


INITIALIZED = Field("initialized", "Initialized", BOOL, recorded=False)
HAS_SOURCE = Field("has_source", default=False)


@dataclass(frozen=True)
class DeviceKind:
    """A list of devices of one kind.

    :param count:  entries of the list
    :param make:   gives WPILib's object for an index
    :param real:   how many of them the HAL has; the rest are kept values
    :param config: gives the read-only value at ``config``, for kinds that have one
    """

    name: str
    count: int
    make: Callable[[int], Any] | None
    fields: tuple[Field, ...]
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
        """For each device that the HAL has, whether the robot has made it."""
        if self.make is None:
            return []
        tells = next(field for field in self.fields if field.name == "initialized")
        return [tells.slot(self.make(i)) for i in range(min(self.count, self.real))]


def group(path: str, device: Any, fields: tuple[Field, ...]) -> LiveDict:
    """One dict for a device there is only one of."""
    return LiveDict(path, lambda: {field.name: field.slot(device) for field in fields})
