"""The values that inputs have in the real world, produced by people, gamepads and sensors.

A failure on a stick at 2.0 or a voltage of -3 is not a bug that a team can meet; a failure on a POV at 315 is one.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from ...hal.fields import Quantity
from ...runtime.scripts.targets import PLUGGED
from ...season import CURRENT
from ...wpi import station

_VOLTS = CURRENT.controller.analog_volts

#: Steps beside a constant, relative to it.
_STEPS = (0.001, -0.001, 0.01, -0.01, 0.1, -0.1)

#: Parts of the names of functions that read a value under another name.
_ALSO = {name: (name, "angle", "heading", "rotation2d") for name in ("yaw", "rawyaw")}
#: How often a constant is one of those in comparisons.
_COMPARED = 0.6

#: The value of an input.
Value: TypeAlias = bool | int | float | str | tuple[bool | int | float | str, ...]

#: The kind of an input's values. Units: volts, counts, degrees, degrees per second, turns (0 to 1), g, m/s², amperes,
#: degrees Celsius. An "entry" is one of NetworkTables, whose values `network_values` draws.
InputKind = Literal[Quantity, "axis", "trigger", "button", "pov", "choice", "command", "flag", "number", "entry"]


@dataclass(frozen=True)
class Span:
    """The numbers of one kind.

    :param low: the lowest number
    :param high: the highest number
    :param typical: numbers at which code makes decisions: ends, middles, edges
    :param whole: whether only whole numbers are possible
    """

    low: float
    high: float
    typical: tuple[float, ...]
    whole: bool = False


@dataclass(frozen=True, order=True)
class Input:
    """One input.

    :param target: its name in an input script
    :param kind: the kind of its values
    :param device: what it belongs to: the inputs of one device change together
    :param options: the possible values, for kinds with a few values only
    :param seldom: whether it changes less often than others
    """

    target: str
    kind: InputKind
    device: str = ""
    options: tuple[str, ...] = ()
    seldom: bool = False


@dataclass(frozen=True)
class RobotConstants:
    """The constants of a robot's functions, of its modules and of its classes, in order.

    :param numbers: the finite numbers
    :param compared: those that code compares something with
    :param texts: the short strings
    :param names: the names of what its functions call and read
    """

    numbers: tuple[float, ...] = ()
    compared: tuple[float, ...] = ()
    texts: tuple[str, ...] = ()
    names: frozenset[str] = frozenset()

    def near(self, rng: random.Random, low: float, high: float, scales: Sequence[float] = (1.0,)) -> float | None:
        """Return a number at, beside or between the constants, from `low` to `high`; None if none of them is there.

        :param scales: what the constants are multiplied with, one of these at a time
        """
        scale = scales[0] if len(scales) == 1 else rng.choice(scales)
        # Most decisions are comparisons; but a constant's name may be what is compared.
        known = self.compared if self.compared and rng.random() < _COMPARED else self.numbers
        numbers = [each for each in known if low <= each * scale <= high]
        if not numbers:
            return None
        index = rng.randrange(len(numbers))
        value = numbers[index] * scale
        how = rng.random()
        if how < 0.25 and index + 1 < len(numbers):  # where a window between two constants is
            value += rng.random() * (numbers[index + 1] * scale - value)
        elif how < 0.75:
            value += rng.choice(_STEPS) * max(abs(value), 0.1)
        elif how < 0.85:
            value = -value
        return value if low <= value <= high else None

    def asks(self, *names: str) -> bool:
        """Return whether a function uses one of these names."""
        return not self.names.isdisjoint(names)

    def asks_for(self, measured: str) -> bool:
        """Return whether a function uses a name that contains this one: ``getYaw`` reads ``Yaw``."""
        parts = _ALSO.get(measured.lower(), (measured.lower(),))
        return any(part in name.lower() for name in self.names for part in parts)


#: The constants of a robot whose code is not known.
UNKNOWN = RobotConstants()


#: The edges of the dead bands that teams and WPILib use, from both sides.
_DEAD_BANDS = (0.01, 0.019, 0.02, 0.021, 0.05, 0.051, 0.1, 0.101)

SPANS: dict[InputKind, Span] = {
    "axis": Span(-1, 1, (0.0, *(sign * edge for edge in _DEAD_BANDS for sign in (1, -1)))),
    "trigger": Span(0, 1, (0.0, 1.0, 1.0, 0.5, *_DEAD_BANDS)),
    "volts": Span(0, _VOLTS, (0.0, 0.0, _VOLTS, _VOLTS, _VOLTS, _VOLTS / 2, 0.001, _VOLTS - 0.001)),
    # The roboRIO browns out at 6.3 V (the second edition's 6.75 V); below 4.5 V it is off.
    "battery": Span(4.5, 13.5, (12.0, 12.6, 6.3, 6.3, 6.2, 6.7, 6.8, 4.6)),
    "count": Span(-1_000_000, 1_000_000, (0, 0, 1, -1), whole=True),
    "rate": Span(-100_000, 100_000, (0.0,)),
    "angle": Span(-3600, 3600, (0.0, 90.0, -90.0, 179.9, 180.0, -180.0, 359.9, 360.0, -360.0, 720.0)),
    "half turns": Span(-180, 180, (0.0, 90.0, -90.0, 179.9, 180.0, -180.0)),
    "heading": Span(0, 360, (0.0, 90.0, 180.0, 270.0, 359.9)),
    "turning": Span(-720, 720, (0.0, 0.0, 1.0, -1.0)),
    "turns": Span(0, 1, (0.0, 0.0, 0.25, 0.5, 0.75, 0.999, 1.0)),
    "radians": Span(-3.142, 3.142, (0.0, 0.0, 1.571, -1.571, 3.141, -3.141)),
    "radians per second": Span(-12, 12, (0.0, 0.0, 0.01, -0.01)),
    "rotations": Span(-1000, 1000, (0.0, 0.0, 1.0, -1.0, 10.0, 100.0, -100.0)),
    "rpm": Span(-7000, 7000, (0.0, 0.0, 100.0, -100.0, 3000.0, 5676.0, -5676.0)),
    "rail": Span(0, 7, (0.0, 3.3, 5.0, 6.0, 4.5)),
    "acceleration": Span(-2, 2, (0.0, 1.0, -1.0, 2.0, -2.0)),
    "m/s2": Span(-20, 20, (0.0, 0.0, 9.81, -9.81, 19.6, -19.6)),
    "amperes": Span(0, 120, (0.0, 2.0, 40.0, 120.0)),
    # Motor controllers and what protects motors act at 60 to 100 °C.
    "celsius": Span(0, 120, (25, 25, 60, 80, 100), whole=True),
    "hertz": Span(0, 1000, (0, 244, 975), whole=True),
    "range": Span(0, 200, (0.0, 1.0, 200.0)),
    "whole": Span(0, 100, (0, 1, 100), whole=True),
}

POV_ANGLES = (0, 45, 90, 135, 180, 225, 270, 315)

#: By what a user may multiply a number in a dashboard.
_FACTORS = (0.5, 1.0, 2.0)

#: How often a value is near one of the constants in the robot's code.
_NEAR, _NEAR_ON_STICKS = 0.35, 0.15
_STICKS = ("axis", "trigger")

#: How sensors' values relate to the constants in code, which may be in other units: degrees, radians, turns, and the
#: travel of a potentiometer.
_UNSCALED = (1.0,)
_DEGREES = (1.0, 1.0, 180 / math.pi, 360.0)
_RADIANS = (1.0, 1.0, math.pi / 180, 2 * math.pi)
_SCALES: dict[InputKind, tuple[float, ...]] = {
    "angle": _DEGREES,
    "half turns": _DEGREES,
    "heading": _DEGREES,
    "turning": _DEGREES,
    "radians": _RADIANS,
    "radians per second": _RADIANS,
    "m/s2": (1.0, 9.80665),
    "turns": (1.0, 1 / 360, 0.5 / math.pi),
    "volts": (1.0, 1.0, _VOLTS / 360, _VOLTS / 270, 0.5 / math.pi * _VOLTS),
}

_DIGITS = 3


def draw(
    kind: InputKind,
    rng: random.Random,
    options: tuple[str, ...] = (),
    now: float = 0,
    constants: RobotConstants = UNKNOWN,
) -> Any:
    """Return a random value of this kind.

    :param options: the possible values, for kinds with a few values only
    :param now: the input's current value
    :param constants: the constants of the robot's code: values near them are more likely
    """
    span = SPANS.get(kind)
    if span is not None and constants.numbers and rng.random() < (_NEAR_ON_STICKS if kind in _STICKS else _NEAR):
        near = constants.near(rng, span.low, span.high, _SCALES.get(kind, _UNSCALED))
        if near is not None:
            return nearest(kind, near)
    if kind == "axis":
        return _axis(rng)
    if kind == "pov":
        return rng.choice(POV_ANGLES)
    if kind in ("option", "choice", "entry"):
        return rng.choice(options)
    if kind == "command":
        return True
    if kind == "number":
        return now * rng.choice(_FACTORS)
    if span is None:
        return rng.random() < 0.5
    if span.typical and rng.random() < 0.5:
        return rng.choice(span.typical)
    value = rng.uniform(span.low, span.high)
    return round(value) if span.whole else round(value, _DIGITS)


def _axis(rng: random.Random) -> float:
    """Return an axis value: a stick that is pushed is mostly pushed to its end, or nearly."""
    sort = rng.random()
    if sort < 0.4:
        return rng.choice((-1.0, 1.0))
    if sort < 0.55:
        return round(rng.choice((-1, 1)) * rng.uniform(0.9, 1), _DIGITS)
    if sort < 0.7:
        return rng.choice(SPANS["axis"].typical)
    return round(rng.uniform(-1, 1), _DIGITS)


def nearest(kind: InputKind, value: float) -> float:
    """Return the nearest possible value of this kind, rounded to a readable number of digits."""
    span = SPANS[kind]
    inside = min(max(value, span.low), span.high)
    return round(inside) if span.whole else round(float(inside), _DIGITS)


def simpler(kind: InputKind, value: Value) -> Sequence[Value]:
    """Return values of this kind that are shorter to read, the shortest first; for kinds without numbers, none."""
    span = SPANS.get(kind)
    if kind == "entry":
        return _simpler_entry(value)
    if span is None or isinstance(value, bool) or not isinstance(value, int | float):
        return []
    rounded = [round(value, digits) for digits in (1, 2)]
    found: list[float] = [nearest(kind, each) for each in (span.low, span.high, value, *rounded, *span.typical)]
    found = [each for each in dict.fromkeys(found) if len(repr(each)) < len(repr(value))]
    return sorted(found, key=lambda each: (len(repr(each)), abs(each - value)))


def _simpler_entry(value: Value) -> list[Value]:
    found: list[Value] = []
    if isinstance(value, float):
        found = [0.0, 1.0, math.copysign(1.0, value), *(round(value, digits) for digits in (0, 1, 2))]
    elif isinstance(value, tuple):
        zeros = tuple(each if isinstance(each, str) else type(each)(0) for each in value)
        found = [(), value[:1], zeros]
    elif isinstance(value, int) and not isinstance(value, bool):
        found = [0, 1]
    return [each for each in dict.fromkeys(found) if len(repr(each)) < len(repr(value))]


def is_released(target: str, value: object) -> bool:
    """Return whether this write to a joystick lets a control go."""
    return PLUGGED.fullmatch(target) is None and (value == station.NOT_PRESSED if ".povs" in target else not value)


def can_be(kind: InputKind, value: object, options: tuple[str, ...] = ()) -> bool:
    """Return whether an input of this kind can have this value."""
    span = SPANS.get(kind)
    if kind == "pov":
        return value in (station.NOT_PRESSED, *POV_ANGLES)
    if kind in ("option", "choice"):
        return value in options
    if kind == "entry":
        return isinstance(value, bool | int | float | str | tuple)
    if kind == "number":
        return isinstance(value, float)
    if span is None:
        return isinstance(value, bool)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return (isinstance(value, int) or not span.whole) and span.low <= value <= span.high
