"""Objects of the project's classes: all are gone after a run, unless something still holds them, such as a library."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from enum import Enum
from typing import Any

from .modules import ProjectModules
from .part import Part


class ProjectObjects(Part):
    """The instances of classes of the project."""

    def __init__(self, modules: ProjectModules) -> None:
        self._modules = modules

    def restore(self) -> None:
        gc.collect()
        if found := self._found():
            # The collector does not see what C++ holds: a chooser holds commands, whose functions hold the robot.
            for each in found:
                attributes = getattr(each, "__dict__", None)
                if type(attributes) is dict:
                    attributes.clear()
            del found, each
            gc.collect()

    def left_over(self) -> Iterator[str]:
        kinds = {type(each) for each in self._found()}
        for kind in sorted(kinds, key=lambda kind: kind.__qualname__):
            yield f"an object of the class {kind.__module__}.{kind.__qualname__}"

    def _found(self) -> list[Any]:
        names = self._modules.names
        found = [each for each in gc.get_objects() if type(each).__module__ in names]
        # A class may stay for a while in a cache of Python's, and with it the members of an enumeration.
        return [each for each in found if not issubclass(type(each), Enum)]
