"""Only `pyfrc_core.compat` uses private names of WPILib, pytest, paramiko and CPython.

An attribute is found by its name, unless pyfrc gives one of its own the same name.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator
from pathlib import Path

import pyfrc_core
from pyfrc_core.compat import cpython_private, paramiko_private, pytest_private, wpilib_private

ROOT = Path(pyfrc_core.__file__).parents[1]
FILES = [file for package in ("pyfrc", "pyfrc_cli", "pyfrc_core") for file in sorted((ROOT / package).rglob("*.py"))]

#: Names that libraries document in spite of their underscore.
DOCUMENTED = {"_asdict", "_exit", "_fields", "_replace"}
#: Files that may have names in text: they are of files, or what users call their methods.
TEXT_OF_OTHERS = {"pyfrc_core/project/hidden_libraries.py", "pyfrc_core/deploy/import_statements.py"}
#: What runs without pyfrc: the agent on a robot. And what is private to C's library, not to Python.
ON_ITS_OWN = {"pyfrc_core/deploy/agent/system.py", "pyfrc_core/sim/c_exit.py"}

NAMED = {
    each.name
    for names in (
        cpython_private.NAMES,
        cpython_private.THREAD_NAMES,
        paramiko_private.NAMES,
        pytest_private.NAMES,
        pytest_private.ATTRIBUTES,
        wpilib_private.NAMES,
        (wpilib_private.SUBSYSTEMS,),
    )
    for each in names
    if each.name.startswith("_")
}


def is_private(name: str) -> bool:
    return name.startswith("_") and not (name.startswith("__") and name.endswith("__")) and name != "_"


@functools.cache
def nodes_of(file: Path) -> list[ast.AST]:
    return list(ast.walk(ast.parse(file.read_text("utf-8"))))


@functools.cache
def own_names() -> set[str]:
    """Return the names that pyfrc itself gives to something."""
    names: set[str] = set()
    for file in FILES:
        for node in nodes_of(file):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                names.add(node.name)
            elif isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Store):
                names.add(node.id if isinstance(node, ast.Name) else node.attr)
    return names


def private_names(file: Path, own: set[str]) -> Iterator[tuple[int, str]]:
    for node in nodes_of(file):
        names: list[str] = []
        if isinstance(node, ast.Attribute):
            names = [node.attr] if node.attr not in own else []
        elif isinstance(node, ast.Import):
            names = [part for alias in node.names for part in alias.name.split(".")]
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and not (node.module or "").startswith("pyfrc"):
            names = [*(node.module or "").split("."), *(alias.name for alias in node.names)]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            names = [node.value] if node.value in NAMED - own else []
        for name in names:
            if is_private(name) and name not in DOCUMENTED:
                yield node.lineno, name


def test_private_names_of_libraries_are_used_in_compat_only() -> None:
    own = own_names()
    found = []
    for file in FILES:
        path = file.relative_to(ROOT).as_posix()
        if path.startswith(("pyfrc_core/compat/", "pyfrc_cli/templates/")) or path in ON_ITS_OWN | TEXT_OF_OTHERS:
            continue
        found += [f"{path}:{line}: {name}" for line, name in private_names(file, own)]
    assert found == [], "use them through pyfrc_core.compat, with a test in tests/test_compat_*.py"


def test_the_check_finds_them() -> None:
    compat = ROOT / "pyfrc_core" / "compat" / "cpython_private.py"
    assert {"_thread", "_getframe", "_current_frames"} <= {name for _, name in private_names(compat, own_names())}
