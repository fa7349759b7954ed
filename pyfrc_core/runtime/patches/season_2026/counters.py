"""Replace the functions of `wpilib.Counter`: in WPILib's simulated HAL they always return 0."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

import wpilib

from ....hal.season_2026.counters import EdgeCounter, EdgeInput, take_counter
from ....patch_table import Patch

_Mode = wpilib.Counter.Mode

#: Functions that WPILib calls on a subclass in Python, so that a replacement must not call the original.
_VIRTUAL = ("reset", "setMaxPeriod")

#: The counters of this process.
_counters: WeakKeyDictionary[wpilib.Counter, EdgeCounter] = WeakKeyDictionary()


def _edge_counter_of(counter: wpilib.Counter) -> EdgeCounter:
    found = _counters.get(counter)
    if found is None:
        found = _counters[counter] = take_counter()
    return found


def patches() -> list[Patch]:
    """Return the functions of `wpilib.Counter` to replace."""
    getters: dict[str, Callable[[EdgeCounter], Any]] = {
        "get": lambda counter: counter.count,
        "getFPGAIndex": lambda counter: counter.index,
        "getDirection": lambda counter: counter.forward,
        "getStopped": lambda counter: counter.stopped,
        "getPeriod": lambda counter: counter.period,
        "getRate": lambda counter: counter.distance_per_pulse / counter.period if counter.period else math.inf,
        "getDistance": lambda counter: counter.count * counter.distance_per_pulse,
    }
    setters: dict[str, Callable[..., None]] = {
        "__init__": _construct,
        "reset": lambda counter: setattr(counter, "count", 0),
        "setUpSource": lambda counter, *args, **kwargs: counter.connect("up", _first(args, kwargs)),
        "setDownSource": lambda counter, *args, **kwargs: counter.connect("down", _first(args, kwargs)),
        "clearUpSource": lambda counter: counter.connect("up", None),
        "clearDownSource": lambda counter: counter.connect("down", None),
        "setUpSourceEdge": lambda counter, risingEdge, fallingEdge: _set_edges(counter.up, risingEdge, fallingEdge),
        "setDownSourceEdge": lambda counter, risingEdge, fallingEdge: _set_edges(counter.down, risingEdge, fallingEdge),
        "setUpDownCounterMode": lambda counter: setattr(counter, "mode", _Mode.kTwoPulse),
        "setExternalDirectionMode": lambda counter: setattr(counter, "mode", _Mode.kExternalDirection),
        "setSemiPeriodMode": _set_semi_period,
        "setReverseDirection": lambda counter, reverseDirection: setattr(counter, "reverse", reverseDirection),
        "setMaxPeriod": lambda counter, maxPeriod: setattr(counter, "max_period", maxPeriod),
        "setDistancePerPulse": lambda counter, distancePerPulse: setattr(
            counter, "distance_per_pulse", distancePerPulse
        ),
    }
    return [
        *(Patch(wpilib.Counter, name, _getter(read)) for name, read in getters.items()),
        *(Patch(wpilib.Counter, name, _setter(name, change)) for name, change in setters.items()),
    ]


def _getter(read: Callable[[EdgeCounter], Any]) -> Callable[..., Any]:
    def get(self: wpilib.Counter) -> Any:
        return read(_edge_counter_of(self))

    return get


def _setter(name: str, change: Callable[..., None]) -> Callable[..., Any]:
    original = getattr(wpilib.Counter, name)
    call = getattr(original, "__func__", original)

    def set_(self: wpilib.Counter, *args: Any, **kwargs: Any) -> None:
        if name not in _VIRTUAL:
            call(self, *args, **kwargs)  # refuses wrong arguments
        change(_edge_counter_of(self), *args, **kwargs)

    return set_


def _construct(counter: EdgeCounter, *args: Any, **kwargs: Any) -> None:
    values = [*args, *kwargs.values()]
    mode = next((value for value in values if isinstance(value, _Mode)), None)
    if mode is not None or not values:
        counter.mode = mode or _Mode.kTwoPulse
        return
    if len(values) == 1:
        counter.connect("up", values[0])
        return
    named = dict(zip(("encodingType", "upSource", "downSource", "inverted"), args, strict=False)) | kwargs
    counter.mode, counter.reverse = _Mode.kExternalDirection, named["inverted"]
    counter.connect("up", named["upSource"])
    counter.connect("down", named["downSource"])
    if named["encodingType"] == wpilib.Counter.EncodingType.k2X:
        _set_edges(counter.up, True, True)


def _first(args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
    """Return the first argument of a function, whatever its name is."""
    return args[0] if args else next(iter(kwargs.values()))


def _set_edges(source: EdgeInput | None, rising: bool, falling: bool) -> None:
    if source is not None:
        source.rising, source.falling = rising, falling


def _set_semi_period(counter: EdgeCounter, highSemiPeriod: bool) -> None:
    counter.mode, counter.high_pulses = _Mode.kSemiperiod, highSemiPeriod
