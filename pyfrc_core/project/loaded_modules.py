"""The modules that this process has imported from elsewhere than Python itself and the installed packages."""

from __future__ import annotations

import os
import sys
import sysconfig
from functools import cache
from itertools import islice
from types import ModuleType

from .robot_files import is_pyfrc

#: The names of directories of installed packages.
PACKAGES = ("site-packages", "dist-packages")
_IN_PACKAGES = tuple(f"{os.sep}{name}{os.sep}" for name in PACKAGES)

#: How many of the newest modules are looked at first.
_FEW = 64


class LoadedModules:
    """Those modules: the project's own, its tests, libraries beside it, and an editable pyfrc.

    A process has imported some 2,000 modules, and a fork that asks each of them for its file copies the memory of all.
    Each look therefore goes only through those imported since the last one.
    """

    def __init__(self) -> None:
        self._names: dict[str, None] = {}
        self._pyfrc: dict[str, None] = {}
        self._newest: str | None = None

    def look(self) -> list[ModuleType]:
        """Return the modules that are loaded now, except pyfrc's own, in the order of their first import.

        Each has a ``__file__``, which is absolute.
        """
        for name, module in self._new_modules():
            file = _file_of(module)
            if file is None or file.startswith(_standard_library()) or any(part in file for part in _IN_PACKAGES):
                continue
            if is_pyfrc(file):
                self._pyfrc[file] = None
            else:
                self._names[name] = None
        modules = map(sys.modules.get, list(self._names))
        return [module for module in modules if isinstance(module, ModuleType) and _file_of(module) is not None]

    def files_of_pyfrc(self) -> list[str]:
        """Return the source files of pyfrc that were loaded until the last look, if pyfrc is not among the packages."""
        return list(self._pyfrc)

    def _new_modules(self) -> list[tuple[str, ModuleType]]:
        """Return what was imported since the last look, and perhaps some that was before."""
        count = _FEW
        while True:
            try:
                newest = list(islice(reversed(sys.modules.items()), count))
            except RuntimeError:  # another thread has imported meanwhile
                continue
            if len(newest) < count or any(name == self._newest for name, _ in newest):
                break
            count *= 4
        self._newest = newest[0][0]
        return newest[::-1]


def _file_of(module: object) -> str | None:
    if not issubclass(type(module), ModuleType):  # an object may claim to be one
        return None
    # Not an attribute of its own: a module's `__getattr__` may do anything, such as import or make a device.
    file = ModuleType.__getattribute__(module, "__dict__").get("__file__")
    return file if isinstance(file, str) and os.path.isabs(file) else None  # noqa: PTH117 - some 2,000 times


@cache
def _standard_library() -> tuple[str, ...]:
    return tuple(sysconfig.get_path(name) + os.sep for name in ("stdlib", "platstdlib"))


#: Those of this process.
loaded_modules = LoadedModules()
