"""The values in a broken rule: what the parts of its condition were.

pytest shows them by rewriting a test file's asserts when it imports the file. The rules must also be explained in
processes without pytest, so here the parts of the condition are evaluated once more, after it has failed.
"""

from __future__ import annotations

import ast
import inspect
import linecache
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import CodeType, ModuleType
from typing import Any

#: The maximum length of a value that is shown.
_LONGEST = 60

_INNER_SCOPES = (ast.Lambda, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


@dataclass(frozen=True)
class Moment:
    """A line of a function while it runs.

    :param code: the function's code
    :param line: the line's number
    :param names: the variables by name, local ones first
    """

    code: CodeType
    line: int
    names: dict[str, Any]


def moment_of_return(code: CodeType, call: Callable[[], object]) -> Moment | None:
    """Call a function once more, and return the moment of its `return`; None if it raises something now."""
    found: list[Moment] = []

    def profile(frame: Any, event: str, argument: object) -> None:
        if event == "return" and frame.f_code is code:
            found.append(Moment(code, frame.f_lineno, {**frame.f_globals, **frame.f_locals}))

    before = sys.getprofile()
    sys.setprofile(profile)
    try:
        call()
    except Exception:
        return None
    finally:
        sys.setprofile(before)
    return found[-1] if found else None


def values_at(moment: Moment, hidden: tuple[str, ...] = ()) -> list[str]:
    """Return the values in the `assert` or `return` at this line, such as ``robot.arm.angle is 12.5``.

    :param hidden: names whose values are not shown
    """
    condition = _condition_at(moment)
    if condition is None:
        return []
    found: dict[str, str] = {}
    for node in _terms(condition):
        text = ast.unparse(node)
        if text in hidden or text in found:
            continue
        try:
            value = eval(compile(ast.Expression(node), "<rule>", "eval"), dict(moment.names))
            shown = _shown(value)
        except Exception:  # such as a part that Python did not evaluate, since another one had decided
            continue
        if shown is not None:
            found[text] = f"{text} is {shown}"
    return list(found.values())


def _condition_at(moment: Moment) -> ast.expr | None:
    linecache.checkcache(moment.code.co_filename)
    source = "".join(linecache.getlines(moment.code.co_filename))
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):  # the file has changed
        return None
    for node in ast.walk(tree):
        if isinstance(node, ast.Assert | ast.Return) and node.lineno <= moment.line <= (node.end_lineno or 0):
            return node.test if isinstance(node, ast.Assert) else node.value
    return None


def _terms(node: ast.AST) -> Iterator[ast.expr]:
    """Yield the names, attributes, items and calls of a condition that are not part of a longer one."""
    if isinstance(node, ast.Name | ast.Attribute | ast.Subscript):
        yield node
    elif isinstance(node, ast.Call):
        yield node
        for argument in (*node.args, *(keyword.value for keyword in node.keywords)):
            yield from _terms(argument)
    elif not isinstance(node, _INNER_SCOPES):
        for child in ast.iter_child_nodes(node):
            yield from _terms(child)


def _shown(value: object) -> str | None:
    """Return the text of a value; None if it does not say more than the value's type."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, ModuleType | type) or inspect.isroutine(value) or type(value).__repr__ is object.__repr__:
        return None
    text = repr(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
