"""The names that modules of the standard library lack on a system, from the stubs in typeshed, which mypy brings."""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import SimpleNamespace

#: The modules with names that robot code and pyfrc could miss.
MODULES = ("os", "signal", "select", "selectors", "socket", "time", "sys", "mmap", "faulthandler")


def absent_names(platform: str) -> dict[str, list[str]]:
    """Return the names that each module has here, and lacks on a system.

    :param platform: as in `sys.platform`
    """
    absent = {}
    for module in MODULES:
        here = _names(module, "linux")
        lacking = here - _names(module, platform)
        absent[module] = sorted(lacking & {*dir(importlib.import_module(module))})
    return absent


def _names(module: str, platform: str) -> set[str]:
    import mypy

    stubs = Path(mypy.__path__[0]) / "typeshed" / "stdlib"
    file = next(file for file in (stubs / f"{module}.pyi", stubs / module / "__init__.pyi") if file.is_file())
    return set(_defined(ast.parse(file.read_text(encoding="utf-8")).body, platform))


def _defined(body: Sequence[ast.stmt], platform: str) -> Iterator[str]:
    for statement in body:
        if isinstance(statement, ast.If):
            yield from _defined(statement.body if _holds(statement.test, platform) else statement.orelse, platform)
        elif isinstance(statement, ast.FunctionDef | ast.ClassDef):
            yield statement.name
        elif isinstance(statement, ast.Assign):
            yield from (target.id for target in statement.targets if isinstance(target, ast.Name))
        elif isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
            yield statement.target.id
        elif isinstance(statement, ast.ImportFrom) and statement.module is not None:
            for alias in statement.names:
                if alias.name == "*":
                    yield from _names(statement.module, platform)
                elif alias.asname == alias.name:
                    yield alias.name


def _holds(test: ast.expr, platform: str) -> bool:
    """Return whether a condition of a stub holds there, such as ``sys.platform != "win32"``."""
    here = SimpleNamespace(platform=platform, version_info=sys.version_info)
    return bool(eval(ast.unparse(test), {"sys": here, "TYPE_CHECKING": True}))
