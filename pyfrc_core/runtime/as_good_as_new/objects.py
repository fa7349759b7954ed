"""Objects of the project's classes that something still holds, such as a library's list of what it has registered."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from enum import Enum

from .modules import ProjectModules
from .part import Part


class ProjectObjects(Part):
    """The instances of classes of the project."""

    def __init__(self, modules: ProjectModules) -> None:
        self._modules = modules

    def left_over(self) -> Iterator[str]:
        names = self._modules.names
        found = {type(each) for each in gc.get_objects() if type(each).__module__ in names}
        # A class may stay for a while in a cache of Python's, and with it the members of an enumeration.
        found = {kind for kind in found if not issubclass(kind, Enum)}
        for kind in sorted(found, key=lambda kind: kind.__qualname__):
            yield f"an object of the class {kind.__module__}.{kind.__qualname__}"
