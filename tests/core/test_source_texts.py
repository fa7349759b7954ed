"""What may not be in the texts of pyfrc's source, which are help, hints and errors."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

#: Drawn in a window or a page, or compared with what users have written.
NOT_PRINTED = (
    "pyfrc_core/sim/ui/models/",
    "pyfrc_core/sim/ui/tk/",
    "pyfrc_core/sim/ui/web/",
    "pyfrc_core/config/toml_file.py",
    "pyfrc_core/deploy/manifest.py",
    "pyfrc_core/explain/syntax.py",
    "pyfrc_core/terminal_text.py",
)

#: Where commands are for a robot, or the system is asked before.
ELSEWHERE = (
    "pyfrc_core/deploy/agent/",
    "pyfrc_core/deploy/installing.py",
    "pyfrc_core/deploy/targets/",
    "pyfrc_core/virtual_robot/",
    "pyfrc_core/shell.py",
)

#: What PowerShell does not run, or what is not there on Windows.
POSIX_ONLY = re.compile(r"\bsudo\b|\bapt(-get)?\b|\bexport \w|bin/activate|\bpython3\b| && |\bchmod\b|\brm -|^\$ ")
#: The same, with what parts of a text may have at their ends.
PERHAPS_POSIX_ONLY = re.compile(r"sudo|\bapt|export|bin/activate|python3|&&|chmod|\brm\b|\$ ")


def sources(*packages: str, left_out: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield name and text of each source file."""
    for file in (each for package in packages for each in sorted((ROOT / package).rglob("*.py"))):
        name = file.relative_to(ROOT).as_posix()
        if not name.startswith(left_out):
            yield name, file.read_text("utf-8")


def texts_in(source: str) -> tuple[list[str], list[str]]:
    """Return the strings of a module: docstrings, and others."""
    nodes = list(ast.walk(ast.parse(source)))
    docstrings = {
        id(node.body[0].value)
        for node in nodes
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef))
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    found: tuple[list[str], list[str]] = [], []
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found[id(node) not in docstrings].append(node.value)
    return found


def test_no_message_has_a_command_that_windows_lacks() -> None:
    found = [
        f"{name}: {text}"
        for name, source in sources("pyfrc_cli", "pyfrc_core", left_out=ELSEWHERE)
        if PERHAPS_POSIX_ONLY.search(source)
        for text in texts_in(source)[1]
        if POSIX_ONLY.search(text)
    ]
    assert found == []


@pytest.mark.parametrize("encoding", ["cp1252", "cp437"])
def test_no_message_needs_an_escape_on_a_console_of_windows(encoding: str) -> None:
    """With what users have written left out."""
    found = [
        f"{name}: {text}"
        for name, source in sources("pyfrc", "pyfrc_cli", "pyfrc_core", left_out=NOT_PRINTED)
        if not source.isascii() or re.search(r"\\[xuUN0-7]", source)
        for text in (text for texts in texts_in(source) for text in texts)
        if text.encode(encoding, "replace").decode(encoding) != text
    ]
    assert found == []
