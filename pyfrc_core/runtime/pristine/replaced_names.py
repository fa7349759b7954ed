"""Functions and classes of libraries, which code may have replaced."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from operator import is_
from types import ModuleType
from typing import Any

from .modules import ProjectModules
from .part import StatePart

_ABSENT: Any = object()

#: Modules whose names no one replaces: what is public of them, other modules have, too; and those of pyfrc, and of what
#: shows tests.
_PRIVATE = re.compile(r"(^|\.)_|^(pyfrc_core|pygments|pluggy)\b")


class ReplacedNames(StatePart):
    """The attributes of modules and their classes that can be called."""

    def __init__(self, modules: ProjectModules) -> None:
        self._modules = modules
        #: Modules and classes by their identity, with their attributes at the beginning.
        self._owners: dict[int, tuple[Any, dict[str, Any], list[Any]]] = {}
        self._known: set[str] = set()
        #: What `restore` could not put back, until that is asked for.
        self._still: list[tuple[Any, str, Any]] | None = None
        self._look_at_new()

    def _look_at_new(self) -> None:
        """Note the attributes of modules that were imported since the last look."""
        for name, module in list(sys.modules.items()):
            if name not in self._known and not self._modules.is_of_project(module):
                self._known.add(name)
                if _PRIVATE.search(name):
                    continue
                if not issubclass(type(module), ModuleType):
                    continue
                self._note(module)
                for value in list(vars(module).values()):
                    if isinstance(value, type) and value.__module__ not in ("builtins", None):
                        self._note(value)

    def _note(self, owner: Any) -> None:
        if id(owner) not in self._owners:
            names = dict(vars(owner))
            self._owners[id(owner)] = owner, names, list(names.values())

    def _changes(self) -> Iterator[tuple[Any, str, Any]]:
        """Yield what was replaced: the owner, the name, and the value of before."""
        for owner, before, values in self._owners.values():
            now = vars(owner)
            if len(now) == len(values) and all(map(is_, now.values(), values)):
                continue
            for name, value in before.items():
                if now.get(name, _ABSENT) is not value and _is_code(value):
                    yield owner, name, value

    def restore(self) -> None:
        changes = list(self._changes())
        for owner, name, value in changes:
            setattr(owner, name, value)
        # To look at all of them again takes as long as all other looks together.
        self._still = [change for change in changes if vars(change[0]).get(change[1], _ABSENT) is not change[2]]

    def left_over(self) -> Iterator[str]:
        changes = list(self._changes()) if self._still is None else self._still
        self._still = None
        for owner, name, _ in changes:
            where = owner.__name__ if isinstance(owner, ModuleType) else f"{owner.__module__}.{owner.__qualname__}"
            yield f"the replaced {where}.{name}"
        self._look_at_new()


def _is_code(value: object) -> bool:
    return callable(value) or isinstance(value, (staticmethod, classmethod, property))
