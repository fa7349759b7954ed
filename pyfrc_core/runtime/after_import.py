"""Call functions after libraries are imported, which physics.py or `robotInit` may do late."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType
from typing import Any

from ..patch_table import PatchTable


def after_import(name: str, function: Callable[[ModuleType], object]) -> None:
    """Call a function with a module, now or after its import. A later call for that module replaces the function."""
    if name in sys.modules:
        _after_import.functions.pop(name, None)
        function(sys.modules[name])
        return
    _after_import.functions[name] = function
    if _after_import not in sys.meta_path:
        sys.meta_path.insert(0, _after_import)


class _AfterImport(MetaPathFinder):
    """Calls a function after a module was imported for the first time."""

    def __init__(self) -> None:
        self.functions: dict[str, Callable[[ModuleType], object]] = {}

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None, /
    ) -> ModuleSpec | None:
        function = self.functions.pop(fullname, None)
        if function is None:
            return None
        spec = find_spec(fullname)  # by the other finders, now that the name is removed here
        if spec is not None and spec.loader is not None:
            loader: Any = spec.loader
            table = PatchTable()

            def exec_module(module: ModuleType) -> None:
                table.undo()
                loader.exec_module(module)
                function(module)

            table.patch(loader, "exec_module", exec_module)
        return spec


_after_import = _AfterImport()
