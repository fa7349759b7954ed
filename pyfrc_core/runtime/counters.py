"""Count the edges of digital inputs for `wpilib.Counter`, for which WPILib's simulated HAL always returns 0.

As on the roboRIO, a counter counts rising edges by default. It has stopped when its last two edges are further apart
than `setMaxPeriod` allows, or the last one is longer ago than that; its period is then infinite and its rate 0. In mode
`setExternalDirectionMode`, it counts up while the down source is high. Analog triggers are not counted, and
`setPulseLengthMode` does not change the direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary, WeakMethod

import wpilib
from wpilib.simulation import DIOSim

from .patch_table import Patch

#: The seconds without an edge after which a counter has stopped, until code sets another limit.
_MAX_PERIOD = 0.5

_Mode = wpilib.Counter.Mode

#: Functions that WPILib calls on a subclass in Python, so that a replacement must not call the original.
_VIRTUAL = ("reset", "setMaxPeriod")


class _Source:
    """A digital input that a counter reads.

    :param on_edge: called at each edge with whether the input has become true
    """

    def __init__(self, channel: int, on_edge: Callable[[bool], None]) -> None:
        self.channel = channel
        self.rising, self.falling = True, False
        self._input = DIOSim(channel)
        self._value = self._input.getValue()
        self._on_edge = on_edge
        look = WeakMethod(self._look)  # the HAL keeps the callback, which must not keep the counter

        def on_value(*_: object) -> None:
            if (found := look()) is not None:
                found()

        self._callback: object = self._input.registerValueCallback(on_value, False)

    @property
    def value(self) -> bool:
        return bool(self._input.getValue())

    def counts(self, value: bool) -> bool:
        """Return whether an edge to this value is counted."""
        return self.rising if value else self.falling

    def close(self) -> None:
        """Stop counting."""
        self._callback = None

    def _look(self) -> None:
        value = self.value
        if value != self._value:
            self._value = value
            self._on_edge(value)


class EdgeCounter:
    """What one `wpilib.Counter` has counted."""

    def __init__(self) -> None:
        self.count = 0
        self.forward = True
        self.reverse = False
        self.mode = _Mode.kTwoPulse
        self.high_pulses = True
        self.max_period = _MAX_PERIOD
        self.distance_per_pulse = 1.0
        self.up: _Source | None = None
        self.down: _Source | None = None
        self._edge: float | None = None
        self._period = math.inf

    def connect(self, name: str, source: Any) -> None:
        """Count the edges of a digital input.

        :param name: ``up`` or ``down``
        :param source: a channel, or a `DigitalSource`; an analog trigger, and None, counts nothing
        """
        before: _Source | None = getattr(self, name)
        if before is not None:
            before.close()
        channel = source if isinstance(source, int) else None
        if isinstance(source, wpilib.DigitalInput):
            channel = source.getChannel()
        found = None if channel is None else _Source(channel, self._on_up if name == "up" else self._on_down)
        setattr(self, name, found)

    @property
    def stopped(self) -> bool:
        """Return whether the last edge is too long ago."""
        return self._edge is None or _now() - self._edge > self.max_period or self._period > self.max_period

    @property
    def period(self) -> float:
        """Return the time between the last two edges, in seconds; in semi-period mode, the length of a pulse."""
        return math.inf if self.stopped else self._period

    def _on_up(self, value: bool) -> None:
        assert self.up is not None
        if self.mode == _Mode.kSemiperiod:
            self._measure_pulse(value)
        if self.up.counts(value):
            backward = self.mode == _Mode.kExternalDirection and self.down is not None and not self.down.value
            self._add(-1 if backward else 1)

    def _on_down(self, value: bool) -> None:
        assert self.down is not None
        if self.mode == _Mode.kTwoPulse and self.down.counts(value):
            self._add(-1)

    def _add(self, step: int) -> None:
        self.forward = (step > 0) != self.reverse
        self.count += 1 if self.forward else -1
        if self.mode == _Mode.kSemiperiod:
            return
        now = _now()
        self._period = math.inf if self._edge is None else now - self._edge
        self._edge = now

    def _measure_pulse(self, value: bool) -> None:
        now = _now()
        if value == self.high_pulses:
            self._edge = now
        elif self._edge is not None:
            self._period = now - self._edge


#: The counters of this process.
_counters: WeakKeyDictionary[wpilib.Counter, EdgeCounter] = WeakKeyDictionary()


def _edge_counter_of(counter: wpilib.Counter) -> EdgeCounter:
    found = _counters.get(counter)
    if found is None:
        found = _counters[counter] = EdgeCounter()
    return found


def counted_channels() -> frozenset[int]:
    """Return the channels of the digital inputs whose edges counters of the robot count."""
    if not _counters:
        return frozenset()
    sources = [source for counter in _counters.values() for source in (counter.up, counter.down)]
    return frozenset(source.channel for source in sources if source is not None)


def patches() -> list[Patch]:
    """Return the functions of `wpilib.Counter` to replace."""
    getters: dict[str, Callable[[EdgeCounter], Any]] = {
        "get": lambda counter: counter.count,
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


def _set_edges(source: _Source | None, rising: bool, falling: bool) -> None:
    if source is not None:
        source.rising, source.falling = rising, falling


def _set_semi_period(counter: EdgeCounter, highSemiPeriod: bool) -> None:
    counter.mode, counter.high_pulses = _Mode.kSemiperiod, highSemiPeriod


def _now() -> float:
    return float(wpilib.Timer.getFPGATimestamp())
