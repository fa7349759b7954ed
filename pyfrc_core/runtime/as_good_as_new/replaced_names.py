"""Functions and classes of libraries, which code may have replaced."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from .modules import ProjectModules
from .part import Part

_ABSENT: Any = object()


class ReplacedNames(Part):
    """The attributes of modules and their classes that can be called."""

    def __init__(self, modules: ProjectModules) -> None:
        self._modules = modules
        self._owners: dict[int, tuple[Any, dict[str, Any]]] = {}
        self._known: set[str] = set()
        self._look_at_new()

    def _look_at_new(self) -> None:
        """Note the attributes of modules that were imported since the last look."""
        for name, module in list(sys.modules.items()):
            if name not in self._known and not self._modules.is_of_project(module):
                self._known.add(name)
                if not issubclass(type(module), ModuleType):
                    continue
                self._note(module)
                for value in list(vars(module).values()):
                    if isinstance(value, type) and value.__module__ not in ("builtins", None):
                        self._note(value)

    def _note(self, owner: Any) -> None:
        self._owners.setdefault(id(owner), (owner, dict(vars(owner))))

    def _changes(self) -> Iterator[tuple[Any, str, Any]]:
        for owner, before in self._owners.values():
            now = vars(owner)
            try:
                if now == before:
                    continue
            except Exception:  # values that cannot be compared, such as arrays
                pass
            for name, value in before.items():
                if now.get(name, _ABSENT) is not value and _is_code(value):
                    yield owner, name, value

    def restore(self) -> None:
        for owner, name, value in list(self._changes()):
            setattr(owner, name, value)

    def left_over(self) -> Iterator[str]:
        for owner, name, _ in self._changes():
            where = owner.__name__ if isinstance(owner, ModuleType) else f"{owner.__module__}.{owner.__qualname__}"
            yield f"the replaced {where}.{name}"
        self._look_at_new()


def _is_code(value: object) -> bool:
    return callable(value) or isinstance(value, (staticmethod, classmethod, property))
