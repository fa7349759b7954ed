"""Source files as blocks: each function's body, and the rest of the module, which runs when it is imported.

A test that has not called a function does not depend on its body. It does depend on the rest of each module that it
imports: signatures, decorators, classes, constants and docstrings.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from .contents import hash_of

#: The name of the block that is not a function's body.
MODULE = ""

_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass(frozen=True)
class Blocks:
    """The blocks of one file.

    :param hashes: of each block's code, without comments, layout and line numbers
    :param lines:  the name of the function that begins in a line, its decorators included
    """

    hashes: dict[str, str]
    lines: dict[int, str]


def blocks_of(source: bytes) -> Blocks:
    """Return the blocks of a file's content. A file that is not valid Python is a single block."""
    try:
        module = ast.parse(source)
    except (SyntaxError, ValueError):
        return Blocks({MODULE: hash_of(source)}, {})
    hashes: dict[str, str] = {}
    lines: dict[int, str] = {}
    names: Counter[str] = Counter()
    for prefix, function in list(_functions(module)):
        name = prefix + function.name
        names[name] += 1
        if names[name] > 1:  # such as a property's getter and setter
            name += f"#{names[name]}"
        lines[min([function.lineno, *(each.lineno for each in function.decorator_list)])] = name
        hashes[name] = hash_of("\n".join(ast.dump(statement) for statement in function.body).encode())
        # Libraries read docstrings when a class is created.
        documentation = ast.get_docstring(function, clean=False)
        function.body = [ast.Expr(ast.Constant(documentation))]
    hashes[MODULE] = hash_of(ast.dump(module).encode())
    return Blocks(hashes, lines)


def _functions(node: ast.AST, prefix: str = "") -> Iterator[tuple[str, ast.FunctionDef | ast.AsyncFunctionDef]]:
    """Yield each function that is not inside another one, with the names of its classes."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, _FUNCTIONS):
            yield prefix, child
        elif isinstance(child, ast.ClassDef):
            yield from _functions(child, f"{prefix}{child.name}.")
        elif not isinstance(child, ast.expr):
            yield from _functions(child, prefix)
