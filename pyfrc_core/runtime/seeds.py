"""Where random generators start from, so that chance is the same in every run."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType
from typing import Any

from ..compat.rev_noise import seed_noise
from ..compat.wpilib_noise import seed_mechanism_noise


def seed_generators(seed: int) -> None:
    """Start Python's global generator, and those of numpy, WPILib's mechanisms and REV's library, from `seed`.

    A library that is imported later, by physics.py or in `robotInit`, is seeded when it is imported.
    """
    random.seed(seed)
    seed_mechanism_noise(seed)
    _on_import.functions = {"numpy": lambda: _seed_numpy(seed), "rev": lambda: _seed_rev(seed)}
    for name in [*_on_import.functions]:
        if name in sys.modules:
            _on_import.functions.pop(name)()
    if _on_import.functions and _on_import not in sys.meta_path:
        sys.meta_path.insert(0, _on_import)


def _seed_numpy(seed: int) -> None:
    sys.modules["numpy"].random.seed(seed % 2**32)


def _seed_rev(seed: int) -> None:
    seed_noise(seed)


class _OnImport(MetaPathFinder):
    """Calls a function after a module was imported for the first time."""

    def __init__(self) -> None:
        self.functions: dict[str, Callable[[], None]] = {}

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None, /
    ) -> ModuleSpec | None:
        function = self.functions.pop(fullname, None)
        if function is None:
            return None
        spec = find_spec(fullname)  # by the other finders, now that the name is removed here
        if spec is not None and spec.loader is not None:
            loader: Any = spec.loader
            execute = loader.exec_module

            def exec_module(module: ModuleType) -> None:
                execute(module)
                function()

            loader.exec_module = exec_module
        return spec


_on_import = _OnImport()
