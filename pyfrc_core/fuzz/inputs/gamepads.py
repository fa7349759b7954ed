"""Find the joysticks that a robot has created, and their classes.

The HAL does not know the classes, so the robot's objects are searched.
"""

from __future__ import annotations

import functools
import types
from collections.abc import Iterator
from typing import Any

from ...wpi import joysticks

#: The search ends after this many objects.
_MOST_OBJECTS = 20_000

_CONTAINERS = (list, tuple, set, frozenset)
#: Objects that are not followed, since they refer to everything in the process.
_TOO_FAR = (types.ModuleType, type)


def find_gamepads(robot: object) -> dict[int, str]:
    """Return the class name of the joystick at each port, as far as they are found."""
    found: dict[int, str] = {}
    for stick in _reachable(robot):
        name = joysticks.class_of(stick)
        if name in joysticks.TRIGGERS or found.get(joysticks.port_of(stick)) is None:
            found[joysticks.port_of(stick)] = name
    return dict(sorted(found.items()))


def _reachable(robot: object) -> Iterator[joysticks.GenericHID]:
    """Search breadth first, through attributes, containers and the closures of functions."""
    seen, waiting = {id(robot)}, [robot]
    for each in waiting:
        if joysticks.is_joystick(each):
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
