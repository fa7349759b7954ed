"""Values for the entries of NetworkTables that robot code reads.

There are two kinds of entries. A *setting* has a value from the robot, or belongs to a dashboard: a user changes it
within reason, so a positive number stays positive or becomes 0. The others are *measured* outside the robot, by a
camera or a coprocessor, and take any value; of a pose, all numbers may be NaN.
"""

from __future__ import annotations

import math
import random
import re
from dataclasses import dataclass
from typing import Any

from ...runtime.scripts.network_entries import NOT_A_NUMBER
from ...wpi import names
from .values import RobotConstants, Value

#: What cameras measure, by the last part of the entry's name; the first match counts. The limits are Limelight's.
_MEASURED: tuple[tuple[str, float, float], ...] = (
    (r"^tx(nc)?$", -29.8, 29.8),
    (r"^ty(nc)?$", -24.85, 24.85),
    (r"^ta$|area", 0.0, 100.0),
    (r"^t[lc]$|latency", 0.0, 100.0),
    (r"yaw|pitch|roll|angle|heading|rotation", -180.0, 180.0),
    (r"dist|range", 0.0, 17.0),
)
#: An entry that says whether a camera sees a target, and the one with its number (tags have the numbers from 1).
SEES_TARGET = re.compile(r"^tv$|has_?targets?$|target_?visible|sees_?target", re.IGNORECASE)
_TAG = re.compile(r"^tid$|tag_?id|fiducial_?id", re.IGNORECASE)
_TAGS = 32

#: A time that a camera's measurement needs now and then, in milliseconds: its computer was busy with something else.
_LATENCY = re.compile(r"^t[lc]$|latency", re.IGNORECASE)
_DELAYS = (250.0, 1000.0, 5000.0)
_DELAYED = 0.1

#: A pose that a camera may fail to compute, and how often; a Limelight then sends zeros.
_POSE = re.compile(r"(?!.*limelight).*(pose|transform|translation|rotation)[^/]*$", re.IGNORECASE)
_NOT_COMPUTED = 0.06

_DIGITS = 3
_FACTORS = (0.5, 0.5, 2.0, 2.0, 1.1, 0.9, 1.0, 10.0)
#: For a number that is 0.
_FROM_ZERO = (1.0, 0.5, 0.1, 2.0, 5.0, 10.0)

#: The structs of doubles that cameras send, with the span of each number (meters, radians, parts of a quaternion).
_METERS, _RADIANS = (-1.0, 17.0), (-3.141, 3.141)
STRUCTS: dict[str, tuple[tuple[float, float], ...]] = {
    "Translation2d": (_METERS, _METERS),
    "Rotation2d": (_RADIANS,),
    "Pose2d": (_METERS, _METERS, _RADIANS),
    "Transform2d": (_METERS, _METERS, _RADIANS),
    "ChassisSpeeds": ((-5.0, 5.0), (-5.0, 5.0), (-12.0, 12.0)),
}


@dataclass(frozen=True)
class NetworkRead:
    """An entry that robot code reads.

    :param name: its full name
    :param type_name: the name of its type in NetworkTables
    :param default: the value if there is none
    """

    name: str
    type_name: str
    default: Any = None


def is_setting(name: str) -> bool:
    """Return whether an entry belongs to a dashboard or to the preferences."""
    return name.startswith(names.SETTINGS)


class NetworkValues:
    """Draws values for entries."""

    def __init__(self, rng: random.Random, constants: RobotConstants) -> None:
        self._rng = rng
        self._constants = constants

    def draw(self, read: NetworkRead, before: object, setting: bool) -> Value:
        """Return a value for an entry.

        :param before: the value that the robot has given it, or reads if there is none
        :param setting: whether a user sets it
        """
        element, is_list = read.type_name.removesuffix("[]"), read.type_name.endswith("[]")
        if element.startswith("struct:"):
            return self._structs(read.name, element.removeprefix("struct:"), is_list, setting)
        if not is_list:
            return self._one(read.name, element, before, setting)
        values = tuple(before) if isinstance(before, list | tuple) else ()
        how = self._rng.random()
        if how < 0.2:
            return ()
        length = len(values) or self._rng.choice((1, 2, 3, 6))
        if how < 0.35:
            length = max(1, length + self._rng.choice((-1, 1, 5)))
        if not setting and element in ("float", "double") and self._is_not_computed(read.name):
            return (NOT_A_NUMBER,) * length
        padded = (*values, *[_zero(element)] * length)[:length]
        return tuple(self._one(read.name, element, each, setting) for each in padded)

    def without_target(self, read: NetworkRead) -> Value:
        """Return the value that a camera sends while it sees no target."""
        element = read.type_name.removesuffix("[]")
        if read.type_name.endswith("[]"):
            length = len(read.default) if isinstance(read.default, list | tuple) else 0
            return () if element.startswith("struct:") else (_zero(element),) * length
        if element.startswith("struct:"):
            return (0.0,) * len(STRUCTS[element.removeprefix("struct:")])
        if _TAG.search(_last(read.name)):
            return -1 if element == "int" else -1.0
        return _zero(element)

    def _structs(self, entry: str, name: str, is_list: bool, setting: bool) -> tuple[float | str, ...]:
        count = self._rng.choice((0, 1, 1, 2)) if is_list else 1
        spans = STRUCTS[name] * count
        if not setting and self._is_not_computed(f"{entry} {name}"):
            return (NOT_A_NUMBER,) * len(spans)
        return tuple(round(self._rng.uniform(low, high), _DIGITS) for low, high in spans)

    def _is_not_computed(self, name: str) -> bool:
        return _POSE.match(name) is not None and self._rng.random() < _NOT_COMPUTED

    def _one(self, name: str, element: str, before: object, setting: bool) -> bool | int | float | str:
        if element == "boolean":
            return not before if self._rng.random() < 0.7 else bool(before)
        if element == "string":
            return self._text(_last(name), before if isinstance(before, str) else "")
        base = float(before) if isinstance(before, int | float) and math.isfinite(before) else 0.0
        value = self._setting(base) if setting else self._measured(_last(name), base, element == "int")
        return round(value) if element == "int" else round(float(value), _DIGITS)

    def _text(self, name: str, before: str) -> str:
        rng, how = self._rng, self._rng.random()
        texts = [text for text in self._constants.texts if text not in (name, before)]
        if texts and how < 0.8:
            return rng.choice(texts)
        return rng.choice(("", before, before.upper(), before.lower(), "?"))

    def _setting(self, base: float) -> float:
        """Return a number that a user may type in place of `base`."""
        rng, how = self._rng, self._rng.random()
        if how < 0.4:
            near = self._near()
            if near is not None:
                return abs(near) if base > 0 else -abs(near) if base < 0 else near
        if base:
            return 0.0 if how > 0.9 else base * rng.choice(_FACTORS)
        return rng.choice(_FROM_ZERO) * (-1 if rng.random() < 0.15 else 1)

    def _measured(self, name: str, base: float, whole: bool) -> float:
        """Return a number that comes from outside the robot."""
        rng, how = self._rng, self._rng.random()
        if SEES_TARGET.search(name):
            return float(how < 0.7)
        if _TAG.search(name):
            return rng.randint(1, _TAGS)
        if how > 1 - _DELAYED and _LATENCY.search(name):
            return rng.choice(_DELAYS)
        for pattern, low, high in _MEASURED:
            if re.search(pattern, name, re.IGNORECASE):
                if 0.3 < how < 0.5:  # a small step
                    return min(max(base + rng.uniform(-0.5, 0.5), low), high)
                near = self._near() if how < 0.3 else None
                if near is not None and low <= near <= high:
                    return near
                return rng.choice((0.0, low, high)) if how > 0.85 else rng.uniform(low, high)
        if how < 0.5:
            near = self._near()
            if near is not None:
                return near + (rng.choice((-1, 0, 1)) if whole else 0)
        if how < 0.7:
            return rng.choice((0.0, 1.0, -1.0, base + 1, base - 1, -base))
        return rng.choice((-1, 1)) * math.exp(rng.uniform(math.log(0.1), math.log(1000)))

    def _near(self) -> float | None:
        return self._constants.near(self._rng, -math.inf, math.inf)


def _zero(element: str) -> bool | int | float | str:
    zeros: dict[str, bool | int | float | str] = {"boolean": False, "int": 0, "string": ""}
    return zeros.get(element, 0.0)


def _last(name: str) -> str:
    return name.rpartition("/")[2]
