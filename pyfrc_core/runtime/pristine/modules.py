"""The project's modules: each run imports them again."""

from __future__ import annotations

import importlib
import linecache
import os
import sys
from collections.abc import Iterator
from types import FunctionType, ModuleType
from typing import Any

from ...project.robot_files import RobotFiles
from .part import StatePart

#: Where the classes are of which code makes something by hand that is to stand for a module.
_PLAIN = ("builtins", "types", "unittest.mock")


#: Libraries that keep what a robot has configured in their classes, with no call to forget it: they are imported again,
#: as the project's modules are.
_IMPORTED_ANEW = ("pathplannerlib",)

#: Libraries in C++ whose devices can be made only once in a process: an `XRPMotor` never gives its channel back.
_MADE_ONCE = ("xrp",)


class ProjectModules(StatePart):
    """What is imported, and from where."""

    def __init__(self, files: RobotFiles) -> None:
        self._files = files
        self._paths = {name: list(getattr(sys, name)) for name in ("path", "argv")}
        self._modules = dict(sys.modules)
        #: The names of the project's modules in the last run.
        self.names: set[str] = set()

    def is_of_project(self, module: Any) -> bool:
        """Return whether a module is one of the project's, or like one, or made by hand of what is the project's."""
        kind = type(module)  # an object may claim to be of another class
        if not issubclass(kind, ModuleType):  # it stands for a module
            return kind.__module__ in _PLAIN or self._is_made_by_project(kind)
        values: dict[str, Any] = ModuleType.__getattribute__(module, "__dict__")
        if str(values.get("__name__")).partition(".")[0] in _IMPORTED_ANEW:
            return True
        file, path = values.get("__file__"), values.get("__path__")
        if file is None and path is not None:
            return any(self._files.is_project_file(f"{each}{os.sep}") for each in path)
        if isinstance(file, str):
            return self._files.is_project_file(file)
        # Libraries make modules by hand, too, such as pybind11's builtins.
        return values.get("__spec__") is None and any(map(self._is_made_by_project, list(values.values())))

    def _is_made_by_project(self, value: object) -> bool:
        if not issubclass(type(value), (type, FunctionType)):  # of anything else, to look at it could import something
            return False
        module = sys.modules.get(str(getattr(value, "__module__", None)))
        file = getattr(module, "__file__", None)
        return isinstance(file, str) and self._files.is_project_file(file)

    def restore(self) -> None:
        self.names = set()
        changed = {name: module for name, module in list(sys.modules.items()) if self._modules.get(name) is not module}
        for name in [name for name, module in changed.items() if self.is_of_project(module)]:
            del sys.modules[name]
            if isinstance(getattr(changed[name], "__file__", None), str):
                self.names.add(name)
            self._remove_from_package(name, changed[name])
            if issubclass(type(changed[name]), ModuleType):
                vars(changed[name]).clear()  # its functions would keep what it has, and C++ the functions
        for name, module in self._modules.items():
            sys.modules[name] = module
        for name, values in self._paths.items():
            getattr(sys, name)[:] = values
        # Those of libraries stay: they are not made again.
        sys.meta_path[:] = [each for each in sys.meta_path if not self._is_made_by_project(type(each))]
        importlib.invalidate_caches()
        linecache.checkcache()

    def left_over(self) -> Iterator[str]:
        for name, module in list(sys.modules.items()):
            if name not in self._modules:
                if self.is_of_project(module):
                    self.names.add(name)
                    yield f"the module {name}"
                else:
                    self._modules[name] = module  # a library, which was imported late
        yield from (f"the devices of {name}, which can be made only once" for name in _MADE_ONCE if name in sys.modules)
        for name, values in self._paths.items():
            if getattr(sys, name) != values:
                yield f"what was changed in sys.{name}"

    def _remove_from_package(self, name: str, module: object) -> None:
        package, _, own = name.rpartition(".")
        parent: Any = self._modules.get(package)
        if parent is not None and vars(parent).get(own) is module:
            delattr(parent, own)
