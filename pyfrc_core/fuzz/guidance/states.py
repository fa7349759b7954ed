"""Observe the states of the robot's program: values of its attributes that have few, and which commands run together.

Reaching all lines is easy for a robot that keeps its decisions in a state: what matters is which line runs in which
state. A match that is the first to bring the robot into a state, from one state into another, or into two states at the
same time is worth continuing. Attributes of objects of the robot's own classes are read; no code of the robot's runs.
"""

from __future__ import annotations

import sys
import types
from collections.abc import Iterator
from enum import Enum
from typing import Any

from ...project.robot_files import RobotFiles
from ...runtime.robot import RobotRun
from ...wpi import commands
from ..inputs.device_names import DeviceNames
from ..oracle.growth import CONTAINERS
from .goals import STATE, Goal

#: When attributes are searched for, in packets: objects may appear during a match.
_SEARCHES = frozenset({1, 10, 60, 200, 500, 1000})
_MOST_OBJECTS, _MOST_ATTRIBUTES = 1_000, 300
#: The first attributes that change are also observed in pairs.
_MOST_PAIRED = 24
#: An attribute with more values in one match is no state.
_MOST_VALUES = 24
#: Attributes that have not changed yet are looked at in turn, once in this many packets.
_TURNS = 5
_SMALL_NUMBERS = range(-2, 17)
_LONGEST_TEXT = 40

_ABSENT = object()


class _Attribute:
    def __init__(self, path: str, owner: dict[str, object], name: str) -> None:
        self.path, self.owner, self.name = path, owner, name
        self.value: object = owner.get(name, _ABSENT)
        self.text: str | None = _text_of(self.value)
        self.seen = {self.text}


class RobotStates:
    """The states of one match.

    :param run: the robot's run, which is only read
    :param known: goals that are known, and not reported
    """

    def __init__(self, run: RobotRun, files: RobotFiles, known: frozenset[Goal]) -> None:
        #: The goals that were reached, and when, in microseconds.
        self.reached: dict[Goal, int] = {}
        #: The attributes with elements, by path: their owner's attributes, and their name.
        self.containers: dict[str, tuple[dict[str, object], str]] = {}
        #: The names of its sensors.
        self.names = DeviceNames()
        self._run = run
        self._files = files
        self._known = known
        self._packets = 0
        self._own_classes: dict[type, bool] = {}
        self._found: set[tuple[int, str]] = set()
        #: Keeps the observed objects alive, since they are known by their identity.
        self._owners: list[dict[str, Any]] = []
        self._quiet: list[list[_Attribute]] = [[] for _ in range(_TURNS)]
        self._active: list[_Attribute] = []
        self._commands: tuple[Any, ...] = ()

    def after_packet(self, now_us: int) -> None:
        """Look at the robot once in each packet."""
        self._packets += 1
        if self._packets in _SEARCHES:
            self._search(now_us)
        if turn := self._quiet[self._packets % _TURNS]:
            changed = [each for each in turn if each.owner.get(each.name, _ABSENT) is not each.value]
            for each in changed:
                turn.remove(each)
                self._active.append(each)
        for each in self._active:
            if each.owner.get(each.name, _ABSENT) is not each.value:
                self._change(each, now_us)
        if "commands2" in sys.modules:
            running = commands.scheduled_commands()
            if running != self._commands:
                self._commands = running
                names = sorted({commands.name_of(command) for command in running})
                self._reach((STATE, "commands", "+".join(names)), now_us)

    def _reach(self, goal: Goal, now_us: int) -> None:
        if goal not in self._known and goal not in self.reached:
            self.reached[goal] = now_us

    def _change(self, each: _Attribute, now_us: int) -> None:
        each.value = each.owner.get(each.name, _ABSENT)
        before, each.text = each.text, _text_of(each.value)
        if each.text == before:
            return
        each.seen.add(each.text)
        if each.text is None or len(each.seen) > _MOST_VALUES:
            self._active = [other for other in self._active if other is not each]
            return
        self._reach((STATE, each.path, each.text), now_us)
        if type(each.value) is int:
            return
        if type(each.value) is not bool and before is not None:
            self._reach((STATE, each.path, before, each.text), now_us)
        paired = [other for other in self._active if type(other.value) is not int][:_MOST_PAIRED]
        if each in paired:
            for other in paired:
                if other is not each and other.text is not None:
                    first, second = sorted(((each.path, each.text), (other.path, other.text)))
                    self._reach((STATE, *first, *second), now_us)

    # -- searching ---------------------------------------------------------------------------------------------

    def _search(self, now_us: int) -> None:
        """Find the attributes, breadth first, in the order in which the robot's code has created them."""
        robot = self._run.robot
        if not hasattr(robot, "__dict__"):  # not constructed yet
            return
        seen = {id(robot)}
        waiting: list[tuple[str, Any]] = [("", robot)]
        for path, thing in waiting:
            for name, part in self._parts(path, thing):
                if len(waiting) < _MOST_OBJECTS and id(part) not in seen and self._is_followed(part):
                    seen.add(id(part))
                    waiting.append((name, part))
            if not isinstance(thing, list | tuple | dict):
                self._observe(path, vars(thing), now_us)

    def _observe(self, path: str, owner: dict[str, object], now_us: int) -> None:
        for name in list(owner):
            self.names.add(f"{path}{name}", owner[name])
            if isinstance(owner[name], CONTAINERS):
                self.containers.setdefault(f"{path}{name}", (owner, name))
            if (id(owner), name) in self._found or len(self._found) >= _MOST_ATTRIBUTES:
                continue
            if _text_of(owner[name]) is not None:
                each = _Attribute(f"{path}{name}", owner, name)
                self._quiet[len(self._found) % _TURNS].append(each)
                self._found.add((id(owner), name))
                self._owners.append(owner)
                self._reach((STATE, each.path, str(each.text)), now_us)

    def _parts(self, path: str, thing: object) -> Iterator[tuple[str, Any]]:
        if isinstance(thing, dict):
            for key, value in list(thing.items()):
                yield f"{path}{_text_of(key)}.", value
        elif isinstance(thing, list | tuple):
            for index, value in enumerate(thing):
                yield f"{path}{index}.", value
        else:
            for name, value in list(vars(thing).items()):
                yield f"{path}{name}.", value

    def _is_followed(self, thing: Any) -> bool:
        kind = type(thing)
        if kind in (list, tuple, dict):
            return len(thing) <= _MOST_OBJECTS
        own = self._own_classes.get(kind)
        if own is None:
            file = getattr(sys.modules.get(kind.__module__), "__file__", None)
            own = isinstance(file, str) and self._files.is_robot_code(file) and not issubclass(kind, Enum)
            self._own_classes[kind] = own
        return own and type(getattr(thing, "__dict__", None)) is dict


def _text_of(value: object) -> str | None:
    """Return a text for the value of a state; None for values that are no states, such as measurements."""
    kind = type(value)
    if value is None or kind is bool:
        return str(value)
    if kind is int:
        return str(value) if value in _SMALL_NUMBERS else None
    if kind is str:
        return repr(value) if len(str(value)) <= _LONGEST_TEXT else None
    if isinstance(value, Enum):
        return str(value.name)
    if isinstance(value, types.MethodType):
        return value.__func__.__qualname__
    if commands.is_state_of_machine(value):
        return str(value.name)  # type: ignore[attr-defined]
    return None if value is not _ABSENT else "absent"
