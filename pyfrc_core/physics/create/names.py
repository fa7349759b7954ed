"""Find the names of devices in the robot's attributes, and interpret them."""

from __future__ import annotations

import re
import sys
from collections import deque
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from ...hal import device_table
from ...project.robot_files import RobotFiles
from ...wpi import devices, geometry

#: In metres.
_POSSIBLE_WIDTH = 0.3, 1.0

#: The maximum number of attributes between the robot and a device, and of list elements that are searched.
_DEPTH, _PARTS = 6, 64

_LEFT = {"left", "l", "lf", "fl", "lr", "rl", "lb", "bl", "lm", "ml"}
_RIGHT = {"right", "r", "rf", "fr", "rr", "rb", "br", "rm", "mr"}
_FRONT = {"front", "f", "lf", "fl", "rf", "fr"}
_REAR = {"rear", "back", "lr", "rl", "rr", "lb", "bl", "rb", "br"}

#: Words of drivetrain parts, and words without a meaning here.
_PLAIN = {
    *_LEFT, *_RIGHT, *_FRONT, *_REAR,
    "mid", "middle", "center", "motor", "motors", "controller", "controllers", "drive", "driver", "train",
    "drivetrain", "drivebase", "chassis", "base", "wheel", "wheels", "side", "talon", "spark", "sparkmax",
    "victor", "sp", "srx", "spx", "max", "flex", "leader", "follower", "followers", "master", "slave", "primary",
    "secondary", "main", "encoder", "encoders", "enc", "robot", "container", "subsystem", "subsystems",
    "component", "components", "hardware", "io", "map", "robotmap", "tank", "mecanum", "ports", "devices", "pwm",
    "can", "mc", "cim", "neo", "neos", "falcon", "kraken", "fx", "group", "dt",
}  # fmt: skip

_SWERVE = {"swerve", "steer", "steering", "azimuth"}

#: Words in the names of a swerve module's two motors: the one that turns the wheel, and the one that drives it.
_STEERING = {"steer", "steering", "azimuth", "angle", "pivot", "rotate", "rotation", "turn", "turning"}
_DRIVING = {"drive", "driving", "speed", "propulsion"}
_OF_MODULES = _SWERVE | _STEERING | _DRIVING | {"module", "modules"}


class DeviceName:
    """A device's name in robot code, from the robot down: ``drivetrain.left_motor``."""

    def __init__(self, path: tuple[str, ...] = ()) -> None:
        self.text = one_line(".".join(path).replace(".[", "["))
        self.owner = path[:-1]
        self._words = [_words(part) for part in path]

    def __str__(self) -> str:
        return self.text

    def __bool__(self) -> bool:
        return bool(self.text)

    @property
    def side(self) -> str | None:
        """Return ``left`` or ``right``, or None; the device's own name has priority over its owner's."""
        return self._which({"left": _LEFT, "right": _RIGHT})

    @property
    def end(self) -> str | None:
        """Return ``front`` or ``rear``, or None."""
        return self._which({"front": _FRONT, "rear": _REAR})

    @property
    def is_plain(self) -> bool:
        """Return whether nothing in the name contradicts a drivetrain, as ``left_climber`` does."""
        return bool(self) and not self.purpose

    @property
    def says_swerve(self) -> bool:
        return any(_SWERVE.intersection(words) for words in self._words)

    @property
    def task(self) -> str | None:
        """Return the task of a swerve module's motor by its name, ``drive`` or ``steer``; None for other motors."""
        if self.purpose - _OF_MODULES:
            return None
        for words in reversed(self._words):
            for task, known in (("steer", _STEERING), ("drive", _DRIVING)):
                if known.intersection(words):
                    return task
        return None

    @property
    def purpose(self) -> set[str]:
        """Return the words that distinguish it from other devices, such as ``lift`` in ``lift_motor``."""
        return {
            word
            for words in self._words
            for word in words
            if len(word) > 1 and word not in _PLAIN and not word.isdigit()
        }

    def _which(self, choices: dict[str, set[str]]) -> str | None:
        for words in reversed(self._words):
            matches = [choice for choice, known in choices.items() if known.intersection(words)]
            if len(matches) == 1:
                return matches[0]
        return None


def one_line(text: str) -> str:
    """Return `text` without line breaks and control characters, for a comment."""
    return " ".join("".join(letter if letter.isprintable() else " " for letter in text).split())


def _words(name: str) -> list[str]:
    """Split a name: ``leftMotor_2`` and ``_left_motor2`` both are left, motor, 2."""
    name = re.sub(r"^_[A-Z]\w*?__", "", name)  # as Python stores a name that begins with two underscores
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)]


#: A device's place: the key in `hal_data` and the channel; for a device on the CAN bus ``CAN`` and its number.
Place = tuple[str, int]


class NamedDevice(NamedTuple):
    """A device in the robot's code."""

    name: DeviceName
    #: The robot's object.
    thing: Any


class Reached(NamedTuple):
    """An object that the robot's code holds.

    :param path: the names of the attributes that lead to it
    :param expression: the Python expression for it, from the name ``robot``; empty if there is none
    """

    path: tuple[str, ...]
    thing: Any
    expression: str


def find_objects(robot: object, files: RobotFiles) -> list[Reached]:
    """Return what the robot's code holds, the shortest path first.

    The search covers the robot's attributes, those of the project's own objects, lists and dicts of them, and the
    variables of the project's modules. It calls nothing.
    """
    return list(_reachable(robot, files))


def find_devices(objects: Iterable[Reached]) -> dict[Place, NamedDevice]:
    """Return the robot's devices with their names in its code; the shortest name where there are several.

    Only methods of devices that return a channel are called.
    """
    found: dict[Place, NamedDevice] = {}
    for path, thing, _ in objects:
        for place, suffix in _places(thing):
            found.setdefault(place, NamedDevice(DeviceName((*path[:-1], path[-1] + suffix)), thing))
    return found


def find_track_width(objects: Iterable[Reached]) -> float | None:
    """Return the distance from the left wheels to the right ones in metres, from kinematics or a number of that name.

    A number that is not the width of a robot in metres has another unit, and is ignored.
    """
    for path, thing, _ in objects:
        known = geometry.track_width(thing)
        width = thing if known is None else known
        if not isinstance(width, float) or not _POSSIBLE_WIDTH[0] < width < _POSSIBLE_WIDTH[1]:
            continue
        if width is not thing or "trackwidth" in "".join(_words(path[-1])):
            return width
    return None


def _reachable(robot: object, files: RobotFiles) -> Iterator[Reached]:
    modules = [
        module
        for module in list(sys.modules.values())
        if files.is_robot_code(str(getattr(module, "__file__", None) or ""))
    ]
    waiting: deque[Reached] = deque([Reached((), robot, "robot"), *(Reached((), module, "") for module in modules)])
    seen = {id(robot), *map(id, modules)}
    ours = {module.__name__ for module in modules}
    while waiting:
        path, owner, expression = waiting.popleft()
        for name, value, access in _parts(owner, ours):
            if isinstance(value, float):
                yield Reached((*path, name), value, "")
            if id(value) in seen or isinstance(value, (str, bytes, int, float, type(None))):
                continue
            seen.add(id(value))
            here = Reached((*path, name), value, expression + access if expression and access else "")
            yield here
            if len(here.path) < _DEPTH and _is_looked_into(value, ours):
                waiting.append(here)


def _is_looked_into(value: object, ours: set[str]) -> bool:
    if isinstance(value, (list, tuple, dict, set)):
        return True
    owner = value if isinstance(value, type) else type(value)
    return any(base.__module__ in ours for base in owner.__mro__)


def _parts(owner: object, ours: set[str]) -> Iterable[tuple[str, Any, str]]:
    """Return the name and value of each part, and how Python code gets it from its owner; empty if it cannot."""
    if isinstance(owner, dict):
        items = list(owner.items())[:_PARTS]
        return [(f"[{key}]", value, f"[{key!r}]" if type(key) in (str, int) else "") for key, value in items]
    if isinstance(owner, (list, tuple)):
        return [(f"[{index}]", value, f"[{index}]") for index, value in enumerate(owner[:_PARTS])]
    if isinstance(owner, set):
        return [(f"[{index}]", value, "") for index, value in enumerate(list(owner)[:_PARTS])]
    parts = dict(getattr(owner, "__dict__", {}))
    for base in () if isinstance(owner, type) else type(owner).__mro__:
        if base.__module__ in ours:
            for name, value in vars(base).items():
                parts.setdefault(name, value)
    plain = [(name, value) for name, value in parts.items() if not name.startswith("__")]
    return [(name, value, f".{name}" if name.isidentifier() else "") for name, value in plain]


def _places(thing: object) -> Iterator[tuple[Place, str]]:
    """Return the keys and channels of a device, each with a suffix for its name."""
    kind = devices.wired_kind(thing)
    if kind is None:
        number = _can_number(thing)
        if number is not None:
            yield ("CAN", number), ""
    elif kind == "encoder":
        (index,) = devices.channels_of(thing, kind)
        yield ("encoder", index), ""
        wires = device_table.encoder_channels(index)
        for letter in "AB":
            channel = wires[f"{letter}Source_Channel"]
            if channel is not None:
                yield ("dio", channel), f" {letter}"
    elif kind == "double solenoid":
        forward, reverse = devices.channels_of(thing, kind)
        yield ("solenoid", forward), " forward"
        yield ("solenoid", reverse), " reverse"
    else:
        (channel,) = devices.channels_of(thing, kind)
        for key in _KEYS[kind]:
            yield (key, channel), ""


#: The keys of `hal_data` for each kind of device with one channel.
_KEYS: dict[str, tuple[str, ...]] = {
    "analog gyro": ("analog_gyro", "analog_in"),
    "duty cycle encoder": ("dio",),
    "servo": ("servo", "pwm"),
    "pwm": ("pwm",),
    "digital": ("dio",),
    "analog input": ("analog_in",),
    "relay": ("relay",),
    "solenoid": ("solenoid",),
}

_CAN_NUMBERS = range(63)


def _can_number(thing: object) -> int | None:
    """Return the CAN number of a vendor's motor controller or sensor, from the methods of the vendors' classes."""
    if isinstance(thing, type):
        return None
    for name in ("getDeviceId", "getDeviceID", "get_device_id", "device_id"):
        getter = getattr(type(thing), name, None)
        if getter is None:
            continue
        try:
            number = getattr(thing, name)
            number = number() if callable(number) else number
        except Exception:  # a vendor's class; its number is only for a label
            return None
        return number if isinstance(number, int) and number in _CAN_NUMBERS else None
    return None
