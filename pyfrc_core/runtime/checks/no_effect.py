"""Find lines that do nothing, or something else than they say, without an error.

Such as ``self.command.schedule`` without its brackets, a comparison that is no assertion, and ``if self.beam.get:``.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from functools import cache
from inspect import isfunction, isroutine

from ...explain.commands import is_binding
from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...season import CURRENT
from ...season.spelling import normalized
from ...wpi import names
from .kinds import Kinds
from .sources import CodeWarning, SourceFile, methods_of

#: How methods begin that return something.
_ASKS = re.compile(r"(get|is|has|at)(?=[A-Z_]|$)")
#: What takes the number of a button as its last argument.
_BUTTON = re.compile(r"(get_?raw_?button\w*|joystickbutton)", re.IGNORECASE)
#: Code in these may only look whether an error is raised.
_EXPECTING = frozenset({"raises", "suppress", "warns"})


def find_lines_without_effect(kinds: Kinds) -> Iterator[CodeWarning]:
    assigned = {name for source in kinds.sources for name in _assigned(source)}
    methods = {each.name for source in kinds.sources for cls in source.all(ast.ClassDef) for each in methods_of(cls)}
    functions = (methods - assigned, _library_methods() - assigned)
    for source in kinds.sources:
        for node in _nodes(source.tree):
            if isinstance(node, ast.Expr):
                yield from _of_expression(node.value, source)
            elif isinstance(node, ast.Assign):
                yield from _of_assignment(node, source)
            elif isinstance(node, (ast.If, ast.While, ast.IfExp, ast.Assert)):
                yield from _of_condition(node.test, *functions, source)
            elif isinstance(node, ast.Call):
                yield from _of_call(node, source)
            elif isinstance(node, ast.FunctionDef) and normalized(node.name) == "isfinished":
                inside = {type(each) for each in ast.walk(node)}
                for each in ast.walk(node):
                    if isinstance(each, ast.Return) and each.value is not None:
                        yield from _of_condition(each.value, *functions, source)
                if ast.Call in inside and not inside & {ast.Return, ast.Raise}:
                    text = f"{node.name} returns nothing, so the command never ends by itself"
                    yield source.warning(node, text, "Write return before what it computes.")
        yield from _replaced_methods(source)


def _nodes(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a file, without those where an error is expected."""
    for child in ast.iter_child_nodes(node):
        items = child.items if isinstance(child, ast.With) else []
        contexts = [each.context_expr for each in items if isinstance(each.context_expr, ast.Call)]
        expects = isinstance(child, ast.Try) and child.handlers
        if not expects and not any(last_name(each.func) in _EXPECTING for each in contexts):
            yield child
            yield from _nodes(child)


def _of_expression(value: ast.expr, source: SourceFile) -> Iterator[CodeWarning]:
    """Yield what is wrong with an expression that is a statement of its own."""
    written = ast.unparse(value)
    if isinstance(value, ast.Compare):
        is_equal = isinstance(value.ops[0], ast.Eq) and len(value.ops) == 1
        change = f"To set it, write one =: {ast.unparse(value.left)} = ..." if is_equal else "Write if before it."
        text = "this comparison does nothing: no one looks at its result"
        yield source.warning(value, text, f"Write assert {written}" if source.is_test else change)
    elif isinstance(value, ast.Attribute) or (
        isinstance(value, ast.Name) and isfunction(vars(source.module).get(value.id))
    ):
        yield source.warning(value, f"{written} does nothing: it is not called", f"Write {written}()")
    elif isinstance(value, ast.BinOp) and isinstance(value.op, (ast.Add, ast.Sub, ast.Mult, ast.Div)):
        text = f"{written} is computed, and nothing is done with it"
        yield source.warning(value, text, f"To set it, write: {ast.unparse(value.left)} = {written}")


def _of_assignment(node: ast.Assign, source: SourceFile) -> Iterator[CodeWarning]:
    """Yield ``speed =+ 1``."""
    value, target = node.value, node.targets[0]
    if not isinstance(value, ast.UnaryOp) or not isinstance(value.op, (ast.UAdd, ast.USub)):
        return
    sign = "+" if isinstance(value.op, ast.UAdd) else "-"
    joined = value.lineno == target.end_lineno and value.col_offset - (target.end_col_offset or 0) in (1, 2)
    if joined and (sign == "+" or value.operand.col_offset > value.col_offset + 1):
        text = f"={sign} sets {ast.unparse(target)} to {ast.unparse(value)}, and does not change it by that"
        yield source.warning(node, text, f"Write {ast.unparse(target)} {sign}= {ast.unparse(value.operand)}")


def _of_condition(
    test: ast.expr, methods: set[str], library_methods: frozenset[str], source: SourceFile
) -> Iterator[CodeWarning]:
    """Yield a function that is asked like its value, and a POV whose -1 counts as true."""
    if isinstance(test, ast.Call) and normalized(last_name(test.func)) == "getpov" and CURRENT.year < 2027:
        written, text = ast.unparse(test), "is -1 if nothing is pressed, which counts as true"
        yield source.warning(test, f"{written} {text}", f"Write {written} == 0 for up, 90 for right")
    for each in ast.walk(test):
        if isinstance(each, ast.Compare) and isinstance(each.ops[0], ast.Eq) and _is_time(each.left):
            written, limit = ast.unparse(each.left), ast.unparse(each.comparators[0])
            text = f"{written} is hardly ever {limit} exactly: the loop runs every 20 ms"
            yield source.warning(each, text, f"Write {written} >= {limit}")
    for joined in _alternatives(test):
        if always := [each for each in joined.values[1:] if isinstance(each, ast.Constant) and each.value]:
            text = f"{ast.unparse(joined)} is always true, since {ast.unparse(always[0])} counts as true"
            again = _with_last(joined.values[0], always[0])
            yield source.warning(joined, text, f"Write {ast.unparse(joined.values[0])} or {again}")
    for each in _asked(test):
        name, written = last_name(each), ast.unparse(each)
        # Another library's object may have a value of the same name, but hardly one such as getAngle.
        if written != f"self.{name}" and not _ASKS.match(name):
            continue
        if name in methods or name in library_methods:
            text = f"{written} is a function, which counts as true whatever it would return"
            yield source.warning(each, text, f"Write {written}()")


def _of_call(call: ast.Call, source: SourceFile) -> Iterator[CodeWarning]:
    """Yield ``(one and other).onTrue(...)`` of triggers, and a button that does not exist."""
    bound = call.func.value if isinstance(call.func, ast.Attribute) and is_binding(call) else None
    if isinstance(bound, ast.BoolOp):
        word, sign = ("and", "&") if isinstance(bound.op, ast.And) else ("or", "|")
        written = f" {sign} ".join(map(ast.unparse, bound.values))
        text = f"{word} takes one of the triggers, and does not combine them"
        yield source.warning(call, text, f"Write ({written}).{last_name(call.func)}(...)")
    if call.args and _BUTTON.fullmatch(last_name(call.func)):
        number, first = call.args[-1], CURRENT.first_button
        if isinstance(number, ast.Constant) and type(number.value) is int and not first <= number.value < first + 32:
            text = f"there is no button {number.value}: buttons are {first} to {first + 31}, so it is never pressed"
            remedy = "Write the button's number, or use a method such as getAButton()."
            yield source.warning(call, text, in_2027(remedy))


def _is_time(value: ast.expr) -> bool:
    """Return whether this asks a timer for its seconds."""
    return (
        isinstance(value, ast.Call) and re.search(r"\btimer\.get\(\)$", ast.unparse(value), re.IGNORECASE) is not None
    )


def _alternatives(test: ast.expr) -> Iterator[ast.BoolOp]:
    """Yield each ``or`` of a condition whose truth is asked for."""
    if isinstance(test, ast.UnaryOp):
        yield from _alternatives(test.operand)
    elif isinstance(test, ast.BoolOp):
        if isinstance(test.op, ast.Or):
            yield test
        for each in test.values:
            yield from _alternatives(each)


def _with_last(question: ast.expr, value: ast.Constant) -> str:
    """Return a question that is asked of another value, such as ``stick.getRawButton(2)`` for 2."""
    if isinstance(question, ast.Call) and question.args:
        return ast.unparse(ast.Call(question.func, [*question.args[:-1], value], question.keywords))
    if isinstance(question, ast.Compare):
        return ast.unparse(ast.Compare(question.left, question.ops[:1], [value]))
    return f"{ast.unparse(question)} == {ast.unparse(value)}"


def _asked(test: ast.expr) -> Iterator[ast.expr]:
    """Yield the attributes whose truth a condition asks for, or that it compares with a constant."""
    if isinstance(test, ast.BoolOp):
        for each in test.values:
            yield from _asked(each)
    elif isinstance(test, ast.UnaryOp):
        yield from _asked(test.operand)
    elif isinstance(test, ast.Compare) and all(
        isinstance(each, ast.Constant) and each.value is not None for each in test.comparators
    ):
        yield from _asked(test.left)
    elif isinstance(test, ast.Attribute):
        yield test


def _replaced_methods(source: SourceFile) -> Iterator[CodeWarning]:
    """Yield ``self.isFinished = True`` in a class that has a method of this name."""
    for definition in (each for each in source.tree.body if isinstance(each, ast.ClassDef)):
        cls = vars(source.module).get(definition.name)
        assigned = (each for each in ast.walk(definition) if isinstance(each, ast.Assign))
        for node in (
            each for each in assigned if isinstance(each.value, ast.Constant) and each.value.value is not None
        ):
            for target in (each for each in node.targets if ast.unparse(each).startswith("self.")):
                if isroutine(getattr(cls, last_name(target), None)):
                    text = f"{ast.unparse(node)} replaces the method {last_name(target)}: what calls it fails"
                    remedy = f"Choose another name, or call it: {ast.unparse(target)}(...)"
                    yield source.warning(node, text, remedy)


def _assigned(source: SourceFile) -> Iterator[str]:
    """Yield the names to which a file assigns something, and those of its properties."""
    for node in source.nodes:
        if isinstance(node, (ast.Attribute, ast.Name)) and isinstance(node.ctx, ast.Store):
            yield last_name(node)
        elif isinstance(node, ast.FunctionDef) and node.decorator_list:
            yield node.name


@cache
def _library_methods() -> frozenset[str]:
    """Return the names that are methods in each class of the robot's libraries that has them."""
    found: dict[str, bool] = {}
    for module in [each for name, each in list(sys.modules.items()) if name.partition(".")[0] in names.LIBRARIES]:
        for cls in [each for each in vars(module).values() if isinstance(each, type)]:
            for name, value in list(vars(cls).items()):
                found[name] = found.get(name, True) and callable(value) and not isinstance(value, type)
    return frozenset(name for name, is_method in found.items() if is_method)
