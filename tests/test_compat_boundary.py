"""Only `pyfrc_core.compat` and `pyfrc_core.wpi` use private names of WPILib, pytest and CPython.

An attribute is found by its name, unless pyfrc gives one of its own the same name.
"""

from __future__ import annotations

import ast
import functools
from dataclasses import dataclass
from pathlib import Path

from test_compat_wpilib import private_names

import pyfrc_core
from pyfrc_core.collector import collector_paused
from pyfrc_core.compat import cpython_private, pytest_private

ROOT = Path(pyfrc_core.__file__).parents[1]
FILES = [file for package in ("pyfrc", "pyfrc_cli", "pyfrc_core") for file in sorted((ROOT / package).rglob("*.py"))]

#: Names that libraries document in spite of their underscore.
DOCUMENTED = {"_asdict", "_exit", "_fields", "_replace"}
#: Files that may have names in text: they are of files, or what users call their methods.
TEXT_OF_OTHERS = {"pyfrc_core/project/hidden_libraries.py", "pyfrc_core/deploy/program_imports.py"}
#: What runs without pyfrc: the agent on a robot.
ON_ITS_OWN = {"pyfrc_core/deploy/agent/system.py"}

NAMED = {
    each.name
    for names in (
        cpython_private.NAMES,
        cpython_private.THREAD_NAMES,
        pytest_private.NAMES,
        pytest_private.ATTRIBUTES,
        private_names(),
    )
    for each in names
    if each.name.startswith("_")
}


def is_private(name: str) -> bool:
    return name.startswith("_") and not (name.startswith("__") and name.endswith("__")) and name != "_"


@dataclass(frozen=True)
class Names:
    """The names in a file.

    :ivar own: those that it gives to something
    :ivar attributes: private ones that it reads of something, with their lines
    :ivar imported: likewise, of what it imports
    :ivar written: likewise, in text, those that compat has
    """

    own: set[str]
    attributes: list[tuple[int, str]]
    imported: list[tuple[int, str]]
    written: list[tuple[int, str]]


@functools.cache
def names_in(file: Path) -> Names:
    found = Names(set(), [], [], [])
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            found.own.add(node.name)
        elif isinstance(node, ast.Name):
            if isinstance(node.ctx, ast.Store):
                found.own.add(node.id)
        elif isinstance(node, ast.Attribute):
            if isinstance(node.ctx, ast.Store):
                found.own.add(node.attr)
            if is_private(node.attr):
                found.attributes.append((node.lineno, node.attr))
        elif isinstance(node, ast.Import | ast.ImportFrom):
            found.imported.extend((node.lineno, name) for name in names_of(node) if is_private(name))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in NAMED:
            found.written.append((node.lineno, node.value))
    return found


def names_of(node: ast.Import | ast.ImportFrom) -> list[str]:
    """Return the names in an import of a library."""
    if isinstance(node, ast.Import):
        return [part for alias in node.names for part in alias.name.split(".")]
    module = node.module or ""
    return [] if node.level or module.startswith("pyfrc") else [*module.split("."), *(each.name for each in node.names)]


@functools.cache
def own_names() -> set[str]:
    """Return the names that pyfrc itself gives to something."""
    with collector_paused():  # a tree has many objects, and no garbage
        return set().union(*(names_in(file).own for file in FILES))


def private_names(file: Path, own: set[str]) -> list[tuple[int, str]]:
    found = names_in(file)
    named = [(line, name) for line, name in (*found.attributes, *found.written) if name not in own]
    return [(line, name) for line, name in (*named, *found.imported) if name not in DOCUMENTED]


def test_private_names_of_libraries_are_used_in_compat_only() -> None:
    own = own_names()
    found = []
    for file in FILES:
        path = file.relative_to(ROOT).as_posix()
        if (
            path.startswith(("pyfrc_core/compat/", "pyfrc_core/wpi/", "pyfrc_cli/templates/"))
            or path in ON_ITS_OWN | TEXT_OF_OTHERS
        ):
            continue
        found += [f"{path}:{line}: {name}" for line, name in private_names(file, own)]
    assert found == [], "use them through pyfrc_core.compat or pyfrc_core.wpi, with a test in tests/test_compat_*.py"


def test_the_check_finds_them() -> None:
    compat = ROOT / "pyfrc_core" / "compat" / "cpython_private.py"
    assert {"_thread", "_getframe", "_current_frames"} <= {name for _, name in private_names(compat, own_names())}
