"""What our code gets from ``import``: modules of the standard library without the names that the system's Python lacks.

The names come from typeshed, which mypy brings: `absent_names` compares its stubs for the two systems. The runner does
this once, and interpreters read the list.
"""

from __future__ import annotations

import builtins
import json
import os
import sys
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any

from .callers import Owner, importer

#: The file with the names, in the directory of the run.
NAMES = "absent.json"

_real_import = builtins.__import__


class Imitation(ModuleType):
    """A module of another system: the real one, without some names, and with others in place of its own.

    What is set, such as by a test that replaces a function, is set in the real one, which all code uses.
    """

    def __init__(self, real: ModuleType, absent: frozenset[str], instead: Mapping[str, Any]) -> None:
        super().__init__(real.__name__)
        own = self.__dict__
        for name in ("__name__", "__doc__", "__spec__", "__loader__", "__package__"):
            own.pop(name, None)
        own.update(_real=real, _absent=absent, _own=set(instead), _before={}, **instead)

    def __getattr__(self, name: str) -> Any:
        if name in self._absent:
            raise AttributeError(f"module {self._real.__name__!r} has no attribute {name!r} on this system")
        return getattr(self._real, name)

    def __setattr__(self, name: str, value: object) -> None:
        if name in self._own or name in self._absent:
            self.__dict__[name] = value
        else:
            self._before.setdefault(name, getattr(self._real, name, None))
            setattr(self._real, name, value)

    def __delattr__(self, name: str) -> None:
        if name in self.__dict__:
            del self.__dict__[name]
        elif name in self._before:  # pytest takes back what it has set here: to it, the name was not in this module
            setattr(self._real, name, self._before.pop(name))
        else:
            delattr(self._real, name)

    def __dir__(self) -> list[str]:
        return sorted({*dir(self._real), *self._own} - self._absent)


class Imports:
    """Replaces ``import`` in all code of this process.

    :param missing: modules that the system's Python lacks
    :param absent: names that it lacks, by module
    :param instead: names that it has otherwise, by module; modules that only it has are those without a real one
    :param prepare: by name: called with the real module when anyone has imported it, until it returns True
    """

    def __init__(
        self,
        missing: frozenset[str],
        absent: Mapping[str, frozenset[str]],
        instead: Mapping[str, Mapping[str, Any]],
        only_here: Mapping[str, ModuleType],
        prepare: Mapping[str, Callable[[Any], bool]],
    ) -> None:
        self._missing = missing
        self._absent = absent
        self._instead = instead
        self._only_here = only_here
        self._prepare = dict(prepare)
        self._imitations: dict[str, ModuleType] = dict(only_here)

    def install(self) -> None:
        builtins.__import__ = self._import

    def _import(
        self,
        name: str,
        globals: Mapping[str, Any] | None = None,
        locals: Mapping[str, Any] | None = None,
        fromlist: Any = (),
        level: int = 0,
    ) -> ModuleType:
        if level:
            return _real_import(name, globals, locals, fromlist, level)
        top = name.partition(".")[0]
        ours = (top in self._missing or top in self._absent or top in self._only_here) and importer(
            globals
        ) is Owner.OURS
        if ours and top in self._missing:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        if ours and top in self._only_here:
            return self._only_here[top]
        module = _real_import(name, globals, locals, fromlist, level)
        for each in [each for each in self._prepare if each in sys.modules]:
            if self._prepare[each](sys.modules[each]):
                self._prepare.pop(each, None)
        # Of ``import os.path``, the module is os; of ``from os.path import join``, it is the one with the name.
        if ours and module.__name__ in self._absent:
            return self._imitation(module)
        return module

    def _imitation(self, real: ModuleType) -> ModuleType:
        name = real.__name__
        if name not in self._imitations:
            self._imitations[name] = Imitation(real, self._absent[name], self._instead.get(name, {}))
        return self._imitations[name]


def read_absent(directory: str) -> dict[str, frozenset[str]]:
    """Return the names that the runner has found."""
    with open(os.path.join(directory, NAMES), encoding="utf-8") as file:
        return {module: frozenset(names) for module, names in json.load(file).items()}
