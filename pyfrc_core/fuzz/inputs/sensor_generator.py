"""Generate sensor values: jumps, gradual changes, wheels that turn and stand still."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable, Iterator
from typing import Any

from ...hal import HalData
from ...hal.paths import Segment
from ...runtime.clock import PACKET_US
from .values import SPANS, UNKNOWN, Input, RobotConstants, Value, can_be, draw, nearest

#: Interval of the updates while a value changes gradually.
_STEP_US = 3 * PACKET_US

#: Seconds from one sensor's change to the next one's, on average, and at least.
_PAUSE, _SHORTEST_PAUSE = 1.0, 0.1

#: How often devices change that seldom do, compared with the others.
_SELDOM = 0.25

#: How often a device's value changes that code seems to read, compared with its others.
_READ = 10.0

#: How often an input that a counter counts switches many times, and not once or twice.
_PULSED = 0.5

#: How long something that is soon over lasts, in packets.
_DIPS = (1, 2, 5, 25, 50, 100, 250)

#: Kinds that begin again at their end, and those that are 0 without their sensor.
_WRAPS = ("half turns", "heading", "turns")
_DROPS_OUT = ("volts", "turns", "range")

#: Adds the next writes; returns when to call it again, or None when it is finished.
_Change = Callable[[int, dict[str, Value]], "int | None"]


class SensorGenerator:
    """Generates one match's sensor values."""

    def __init__(self, rng: random.Random, hal_data: HalData, constants: RobotConstants = UNKNOWN) -> None:
        self._rng = rng
        self._constants = constants
        self._hal_data = hal_data
        self.next_us = 0
        #: Devices that are not written.
        self.excluded: set[str] = set()
        self.paused = False
        #: The value of each input when it was last written or read, by target.
        self._known: dict[str, Value] = {}
        self._inputs: list[Input] = []
        #: Where `hal_data` has each input.
        self._places: dict[str, tuple[Any, Segment]] = {}
        self._devices: dict[str, list[Input]] = {}
        self._names: list[str] = []
        self._weights: list[float] = []
        self._of_device: dict[str, list[float]] = {}
        self._change_us = 0
        #: The gradual change of each device, and when it continues.
        self._going: dict[str, tuple[int, _Change]] = {}

    def set_inputs(self, inputs: list[Input]) -> None:
        """Set the inputs to generate values for."""
        if inputs == self._inputs:
            return
        self._inputs, self._devices = inputs, {}
        for each in inputs:
            self._devices.setdefault(each.device, []).append(each)
        self._names = list(self._devices)
        self._weights = [_SELDOM if each[0].seldom else 1.0 for each in self._devices.values()]
        self._of_device = {name: [self._weight(each) for each in values] for name, values in self._devices.items()}

    def write(self, now_us: int, found: dict[str, Value]) -> None:
        """Add the writes of this time."""
        now: dict[str, Value] = {}
        for device, (due_us, go) in list(self._going.items()):
            if device in self.excluded:
                del self._going[device]
            elif due_us <= now_us:
                again_us = go(now_us, now)
                if again_us is None:
                    del self._going[device]
                else:
                    self._going[device] = (again_us, go)
        if now_us >= self._change_us:
            self._change(now_us, now)
            mean = max(_SHORTEST_PAUSE, _PAUSE / (1 + sum(self._weights)))
            self._change_us = now_us + PACKET_US + round(self._rng.expovariate(1 / mean) * 50) * PACKET_US
        self.next_us = min([self._change_us, *(due_us for due_us, _ in self._going.values())])
        self._known |= now
        found |= now

    def find_driven(self) -> Iterator[Input]:
        """Return the inputs that have changed without a write: the project's physics or the robot's code drives them.

        A value that became 0 does not count: robots reset encoders and gyros.
        """
        known = self._known
        for each in self._inputs:
            # Rates follow from other values.
            if each.kind == "rate" or each.device in self.excluded:
                continue
            place = self._places.get(each.target)
            if place is None:
                place = self._places[each.target] = self._hal_data.locate(each.target)
            now = place[0][place[1]]
            if now and known.get(each.target, now) != now:
                yield each
            known[each.target] = now

    def _change(self, now_us: int, found: dict[str, Value]) -> None:
        rng = self._rng
        if not self._names or self.paused:
            return
        (device,) = rng.choices(self._names, self._weights)
        if device in self.excluded:
            return
        inputs = self._devices[device]
        self._going.pop(device, None)
        if inputs[0].kind == "count":
            begun = self._turn_wheel(device, now_us, found)
        else:
            begun = self._measure(rng.choices(inputs, self._of_device[device])[0], now_us, found)
        if begun is not None:
            self._going[device] = begun

    def _weight(self, each: Input) -> float:
        """Return how often a value of a device changes, relative to its others: more, if code seems to read it."""
        found = re.search(r"[A-Za-z]+$", each.target.rstrip('"]'))
        return _READ if found is not None and self._constants.asks_for(found[0]) else 1.0

    def _measure(self, each: Input, now_us: int, found: dict[str, Value]) -> tuple[int, _Change] | None:
        rng = self._rng
        before = self._hal_data.read(each.target)
        if each.kind in ("connected", "battery"):  # a loose contact, a heavy load: mostly soon over
            value = not before if each.kind == "connected" else draw(each.kind, rng, constants=self._constants)
            found[each.target] = value
            rest = before if each.kind == "connected" else round(rng.uniform(11.5, 12.8), 2)
            return now_us + rng.choice(_DIPS) * PACKET_US, _back(each, rest)
        if each.kind == "pulses" and rng.random() < _PULSED:
            return self._pulses(each, now_us)
        if each.kind in ("switch", "pulses"):
            found[each.target] = not before
            if rng.random() < 0.5:
                return now_us + rng.choice((1, 1, 2, 5, 25)) * PACKET_US, _back(each, before)
            return None
        if each.kind in _DROPS_OUT and rng.random() < 0.08:  # a wire is off
            found[each.target] = 0.0
            return now_us + rng.choice(_DIPS) * PACKET_US, _back(each, before)
        value = draw(each.kind, rng, each.options, constants=self._constants)
        if each.kind not in SPANS or SPANS[each.kind].whole or rng.random() < 0.6 or not can_be(each.kind, before):
            found[each.target] = value
            return None
        end_us = now_us + round(rng.uniform(0.3, 4) * 50) * PACKET_US
        span = SPANS[each.kind]
        around = span.high - span.low if each.kind in _WRAPS else 0.0
        if around and rng.random() < 0.5:  # past the end, where the sensor begins again; sometimes several times
            turns = rng.uniform(0.2, 1.5) if rng.random() < 0.7 else rng.uniform(1.5, 5)
            value = before + rng.choice((-1, 1)) * turns * around
            end_us = max(end_us, now_us + round(turns * 25) * PACKET_US)

        def go(at_us: int, found: dict[str, Value]) -> int | None:
            done = min(1.0, (at_us - now_us) / (end_us - now_us))
            now = before + (value - before) * done
            found[each.target] = nearest(each.kind, (now - span.low) % around + span.low if around else now)
            return at_us + _STEP_US if at_us < end_us else None

        return now_us + _STEP_US, go

    def _pulses(self, each: Input, now_us: int) -> tuple[int, _Change]:
        """Turn a wheel whose magnet or slots switch a digital input, which a `Counter` counts."""
        rng = self._rng
        interval_us = rng.choice((1, 1, 2, 5)) * PACKET_US
        end_us = now_us + round(rng.uniform(0.1, 2) * 50) * PACKET_US

        def go(at_us: int, found: dict[str, Value]) -> int | None:
            found[each.target] = not self._hal_data.read(each.target)
            return at_us + interval_us if at_us < end_us else None

        return now_us + interval_us, go

    def _turn_wheel(self, device: str, now_us: int, found: dict[str, Value]) -> tuple[int, _Change] | None:
        """Turn an encoder. Its count continues from the current value, since robots reset it."""
        rng, hal_data = self._rng, self._hal_data
        target, rate_target = f"{device}.count", f"{device}.rate"
        how = rng.random()
        if how < 0.25:  # turned by hand, or the belt has slipped
            per_count = hal_data.read(f"{device}.distance_per_pulse")
            near = self._constants.near(rng, -1e6, 1e6) if rng.random() < 0.5 and per_count else None
            jump = rng.choice((-1, 1)) * rng.choice((1, 10, 500, 20_000))
            found[target] = nearest("count", hal_data.read(target) + jump if near is None else near / per_count)
            return None
        speed = rng.choice((-1, 1)) * math.exp(rng.uniform(math.log(10), math.log(5000)))
        end_us = now_us + round(rng.uniform(0.1, 2) * 50) * PACKET_US
        found[rate_target] = nearest("rate", speed * abs(hal_data.read(f"{device}.distance_per_pulse")))
        turns = how < 0.9  # else it stands still while its last rate is still there

        def go(at_us: int, found: dict[str, Value]) -> int | None:
            if turns:
                found[target] = nearest("count", hal_data.read(target) + speed * _STEP_US / 1_000_000)
            if at_us < end_us:
                return at_us + _STEP_US
            found[rate_target] = 0.0
            return None

        return now_us + _STEP_US, go


def _back(each: Input, value: Value) -> _Change:
    def go(at_us: int, found: dict[str, Value]) -> None:
        found[each.target] = value

    return go
