"""Find the joysticks that a robot has created, and their classes.

The HAL does not know the classes, so the robot's objects are searched.
"""

from __future__ import annotations

import functools
import types
from collections.abc import Iterator
from typing import Any

import wpilib
from wpilib.interfaces import GenericHID

#: The trigger axes of gamepads: their values go from 0 to 1, not from -1.
TRIGGERS: dict[str, tuple[int, ...]] = {"XboxController": (2, 3), "PS4Controller": (3, 4), "PS5Controller": (3, 4)}

#: The search ends after this many objects.
_MOST_OBJECTS = 20_000

_CONTAINERS = (list, tuple, set, frozenset)
#: Objects that are not followed, since they refer to everything in the process.
_TOO_FAR = (types.ModuleType, type)


def find_gamepads(robot: object) -> dict[int, str]:
    """Return the class name of the joystick at each port, as far as they are found."""
    found: dict[int, str] = {}
    for stick in _reachable(robot):
        name = next((each.__name__ for each in type(stick).__mro__ if hasattr(wpilib, each.__name__)), "")
        if name in TRIGGERS or found.get(stick.getPort()) is None:
            found[stick.getPort()] = name
    return dict(sorted(found.items()))


def _reachable(robot: object) -> Iterator[GenericHID]:
    """Search breadth first, through attributes, containers and the closures of functions."""
    seen, waiting = {id(robot)}, [robot]
    for each in waiting:
        if isinstance(each, GenericHID):
            yield each
            continue
        if len(seen) > _MOST_OBJECTS:
            return
        for part in _parts(each):
            if id(part) not in seen and not isinstance(part, _TOO_FAR):
                seen.add(id(part))
                waiting.append(part)


def _parts(thing: object) -> Iterator[Any]:
    if isinstance(thing, dict):
        yield from thing.values()
    elif isinstance(thing, _CONTAINERS):
        yield from thing
    elif isinstance(thing, types.MethodType):
        yield from (thing.__self__, thing.__func__)
    elif isinstance(thing, types.FunctionType):
        for cell in thing.__closure__ or ():
            try:
                yield cell.cell_contents
            except ValueError:  # not bound yet
                continue
        yield from thing.__defaults__ or ()
    elif isinstance(thing, functools.partial):
        yield from (thing.func, *thing.args, *thing.keywords.values())
    else:
        yield from getattr(thing, "__dict__", {}).values()
