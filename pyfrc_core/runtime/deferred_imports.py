"""Import some libraries when the robot's run begins, and not with the robot's modules.

These libraries make a notifier of the HAL's, with a thread in C++, when they are imported. A fork has no such thread,
and the HAL would wait for it. Each fork therefore imports them itself, while everything else has been imported once,
before the fork. Until then, robot code has a stand-in for the module. Names that it imports from there are stand-ins,
too; each passes on what is done with it. A use that cannot wait, such as a call or a derived class, imports the
library at once.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import FrameType, ModuleType
from typing import Any

from ..compat.cpython_private import get_frame
from ..errors import RobotCodeError, text_of
from .cooperative import scope

#: urcl logs what REV's motor controllers send. A static variable of its C++ is a `frc::Notifier`.
LIBRARIES = frozenset({"urcl"})


class DeferredImports(MetaPathFinder):
    """The libraries that the robot's modules have imported, and that are yet to be imported really."""

    def __init__(self) -> None:
        self._waiting: dict[str, str | None] = {}
        self._importing: set[str] = set()

    def install(self) -> None:
        """Defer imports from now on. Calling it again changes nothing."""
        if self not in sys.meta_path:
            sys.meta_path.insert(0, self)

    def uninstall(self) -> None:
        """Defer no more imports; those that are deferred already stay so."""
        if self in sys.meta_path:
            sys.meta_path.remove(self)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return a stand-in for a library of `LIBRARIES`; leave all others to the other finders."""
        library = fullname.partition(".")[0]
        if library not in LIBRARIES or library in self._importing:
            return None
        if fullname != library:  # a submodule: what the library does when it is imported comes first
            self.import_now(library)
            loaded = sys.modules.get(fullname)
            return None if loaded is None else ModuleSpec(fullname, _ImportedAlready(loaded), origin=loaded.__file__)
        self._importing.add(library)
        try:
            found = importlib.util.find_spec(library)
        finally:
            self._importing.discard(library)
        if found is None:
            return None
        self._waiting[library] = _line_that_imports()
        spec = ModuleSpec(library, _StandInLoader(self), origin=found.origin, is_package=True)
        spec.submodule_search_locations = found.submodule_search_locations
        return spec

    def import_all(self) -> None:
        """Import what is deferred: the run begins.

        :raises RobotCodeError: when a library cannot be imported, naming the line that imports it
        """
        for library, line in list(self._waiting.items()):
            try:
                self.import_now(library)
            except Exception as error:
                raise RobotCodeError(
                    text_of(error), where=line, remedy=f"This happens while {library} is imported."
                ) from error

    def import_now(self, library: str) -> ModuleType:
        """Return the library itself; import it, if that has not happened yet."""
        if library in self._waiting:
            stand_in = sys.modules.pop(library, None)
            self._importing.add(library)
            try:
                importlib.import_module(library)
            except BaseException:
                if stand_in is not None:
                    sys.modules[library] = stand_in
                raise
            finally:
                self._importing.discard(library)
            del self._waiting[library]
        return sys.modules[library]

    @property
    def waiting(self) -> frozenset[str]:
        """Return the libraries that are yet to be imported."""
        return frozenset(self._waiting)

    def is_waiting(self, library: str) -> bool:
        """Return whether the library is yet to be imported."""
        return library in self._waiting


#: Those of this process.
deferred_imports = DeferredImports()


class _StandInLoader(Loader):
    """Loads stand-ins."""

    def __init__(self, imports: DeferredImports) -> None:
        self._imports = imports

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return _Module(spec.name, self._imports)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: the library's code runs later."""


class _ImportedAlready(Loader):
    """Returns a submodule that the library has imported itself."""

    def __init__(self, module: ModuleType) -> None:
        self._module = module

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return self._module

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: it has run."""


class _Module(ModuleType):
    """The stand-in for a library."""

    def __init__(self, name: str, imports: DeferredImports) -> None:
        super().__init__(name)
        vars(self)["_pyfrc_imports"] = imports

    def __getattr__(self, name: str) -> Any:
        """Return the library's attribute, or a stand-in for it; called for what is not in this module."""
        imports: DeferredImports = vars(self)["_pyfrc_imports"]
        if not imports.is_waiting(self.__name__):
            return getattr(imports.import_now(self.__name__), name)
        if name.startswith("__"):  # Python, or a tool, looks for optional attributes
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        return _Name(self, name)


class _Name:
    """The stand-in for what was imported from a library."""

    def __init__(self, module: _Module, name: str) -> None:
        self._pyfrc_module = module
        self._pyfrc_name = name

    def _pyfrc_itself(self) -> Any:
        imports: DeferredImports = vars(self._pyfrc_module)["_pyfrc_imports"]
        return getattr(imports.import_now(self._pyfrc_module.__name__), self._pyfrc_name)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # Python, or a tool, looks for optional attributes
            raise AttributeError(name)
        return getattr(self._pyfrc_itself(), name)

    def __call__(self, *args: object, **kwargs: object) -> Any:
        return self._pyfrc_itself()(*args, **kwargs)

    def __mro_entries__(self, bases: tuple[object, ...]) -> tuple[Any, ...]:
        return (self._pyfrc_itself(),)

    def __instancecheck__(self, instance: object) -> bool:
        return isinstance(instance, self._pyfrc_itself())

    def __subclasscheck__(self, subclass: type) -> bool:
        return issubclass(subclass, self._pyfrc_itself())

    def __or__(self, other: Any) -> Any:
        return self._pyfrc_itself() | other

    def __ror__(self, other: object) -> Any:
        return other | self._pyfrc_itself()

    def __repr__(self) -> str:
        return f"<{self._pyfrc_name} of {self._pyfrc_module.__name__}>"


def _line_that_imports() -> str | None:
    """Return the line of the project whose import statement is being executed, such as ``robot.py:3``."""
    frame: FrameType | None = get_frame(1)
    while frame is not None:
        if (line := scope.line_of(frame)) is not None:
            return line
        frame = frame.f_back
    return None
