"""The texts in the source of pyfrc, which are help, hints and errors."""

from __future__ import annotations

import ast
import functools
from pathlib import Path
from typing import NamedTuple

from pyfrc_core.collector import collector_paused


class Texts(NamedTuple):
    """The strings of a module."""

    docstrings: list[str]
    others: list[str]


@functools.cache
def texts_in(file: Path) -> Texts:
    """Return the strings of a module; parsed once for the tests that look at them."""
    found = Texts([], [])
    with collector_paused():  # a tree has many objects, and no garbage
        nodes = list(ast.walk(ast.parse(file.read_text("utf-8"))))
        docstrings = {
            id(node.body[0].value)
            for node in nodes
            if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef))
            and node.body
            and isinstance(node.body[0], ast.Expr)
        }
        for node in nodes:
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                (found.docstrings if id(node) in docstrings else found.others).append(node.value)
    return found
