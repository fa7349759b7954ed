"""Count the edges of digital inputs, as the roboRIO's counters do, which WPILib's simulated HAL does not have.

As on the roboRIO, a counter counts rising edges by default. It has stopped when its last two edges are further apart
than `setMaxPeriod` allows, or the last one is longer ago than that; its period is then infinite and its rate 0. In mode
`setExternalDirectionMode`, it counts up while the down source is high. Analog triggers are not counted, and
`setPulseLengthMode` does not change the direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any
from weakref import WeakMethod, WeakSet, WeakValueDictionary

import wpilib
from wpilib.simulation import DIOSim

from .device_table import COUNTERS

#: The seconds without an edge after which a counter has stopped, until code sets another limit.
_MAX_PERIOD = 0.5

_Mode = wpilib.Counter.Mode


class EdgeInput:
    """A digital input that a counter reads.

    :param on_edge: a method to call at each edge with whether the input has become true
    """

    def __init__(self, channel: int, on_edge: Callable[[bool], None]) -> None:
        self.channel = channel
        self.rising, self.falling = True, False
        self._input = DIOSim(channel)
        self._value = self._input.getValue()
        # Weak, so that a counter ends with the last reference of the robot's code: the HAL keeps the callback, and the
        # counter keeps this.
        self._on_edge = WeakMethod(on_edge)
        look = WeakMethod(self._look)

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
            if (on_edge := self._on_edge()) is not None:
                on_edge(value)


class EdgeCounter:
    """What one counter has counted.

    :param index: its place in `hal_data`
    :param count: what it begins with
    """

    def __init__(self, index: int, count: int = 0) -> None:
        self.index = index
        self.count = count
        self.forward = True
        self.reverse = False
        self.mode = _Mode.kTwoPulse
        self.high_pulses = True
        self.max_period = _MAX_PERIOD
        self.distance_per_pulse = 1.0
        self.up: EdgeInput | None = None
        self.down: EdgeInput | None = None
        self._edge: float | None = None
        self._period = math.inf

    def connect(self, name: str, source: Any) -> None:
        """Count the edges of a digital input.

        :param name: ``up`` or ``down``
        :param source: a channel, or a `DigitalSource`; an analog trigger, and None, counts nothing
        """
        before: EdgeInput | None = getattr(self, name)
        if before is not None:
            before.close()
        channel = source if isinstance(source, int) else None
        if isinstance(source, wpilib.DigitalInput):
            channel = source.getChannel()
        found = None if channel is None else EdgeInput(channel, self._on_up if name == "up" else self._on_down)
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


#: The counters of the robot's code, by index.
_in_use: WeakValueDictionary[int, EdgeCounter] = WeakValueDictionary()

#: What is written for a counter before the robot's code has it.
_not_in_use: dict[int, EdgeCounter] = {}


class _Watch:
    """A function to call when the robot's code takes a counter. It is called as long as this object is kept."""

    def __init__(self, call: Callable[..., object]) -> None:
        self.call = call


_watches: WeakSet[_Watch] = WeakSet()


def take_counter() -> EdgeCounter:
    """Return the first counter that is not in use. It is in use as long as it is kept.

    :raises RuntimeError: when all are in use, as on the roboRIO
    """
    index = next((index for index in range(COUNTERS) if index not in _in_use), None)
    if index is None:
        raise RuntimeError(f"the roboRIO has no more than {COUNTERS} counters, and all are in use")
    before = _not_in_use.pop(index, None)
    counter = _in_use[index] = EdgeCounter(index, before.count if before else 0)
    for watch in list(_watches):
        watch.call()
    return counter


def forget_written_counts() -> None:
    """Forget what was written for counters that the robot's code does not have."""
    _not_in_use.clear()


def counted_channels() -> frozenset[int]:
    """Return the channels of the digital inputs whose edges counters of the robot count."""
    sources = [source for counter in _in_use.values() for source in (counter.up, counter.down)]
    return frozenset(source.channel for source in sources if source is not None)


def _now() -> float:
    return float(wpilib.Timer.getFPGATimestamp())


class CounterSim:
    """A counter in `hal_data`, with functions as WPILib's classes for other simulated devices have them."""

    def __init__(self, index: int) -> None:
        self._index = index

    @property
    def _counter(self) -> EdgeCounter:
        """The robot's counter; what its first values will be, while the robot has none."""
        return _in_use.get(self._index) or _not_in_use.setdefault(self._index, EdgeCounter(self._index))

    def getInitialized(self) -> bool:
        return self._index in _in_use

    def registerInitializedCallback(self, callback: Callable[..., object], notify: bool) -> object:
        watch = _Watch(callback)
        _watches.add(watch)
        return watch

    def getCount(self) -> int:
        return self._counter.count

    def setCount(self, count: int) -> None:
        self._counter.count = count

    def getDirection(self) -> bool:
        return self._counter.forward

    def setDirection(self, forward: bool) -> None:
        self._counter.forward = forward
