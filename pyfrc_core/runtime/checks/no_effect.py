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
from types import BuiltinFunctionType

from ...explain.calls import joined_by_bits
from ...explain.commands import BINDINGS
from ...explain.places import last_name
from ...season import CURRENT
from ...season.spelling import normalized
from ...wpi import names
from .code_warning import CodeWarning
from .kinds import Kinds
from .sources import Source

#: How methods begin that return something.
_ASKS = re.compile(r"(get|is|has|at)(?=[A-Z_]|$)")
#: What takes the number of a button as its last argument.
_BUTTON = re.compile(r"(get_?raw_?button\w*|joystickbutton)", re.IGNORECASE)
#: Code in these may only look whether an error is raised.
_EXPECTING = frozenset({"raises", "suppress", "warns"})


def find_lines_without_effect(kinds: Kinds) -> Iterator[CodeWarning]:
    sources = kinds.sources
    assigned = {name for source in sources for name in _assigned(source.tree)}
    methods = {name for source in sources for name in _methods(source.tree)} - assigned
    for source in sources:
        last = {id(each.body[-1]): each for each in ast.walk(source.tree) if isinstance(each, ast.FunctionDef)}
        asked = {  # by name, methods of a library that are assigned without being called
            name: each.value
            for each in ast.walk(source.tree)
            if isinstance(each, ast.Assign) and isinstance(each.targets[0], ast.Name)
            if isinstance(each.value, ast.Attribute) and kinds.only_returns(ast.Call(each.value, [], []), source)
            for name in [each.targets[0].id]
        }
        for node in _nodes(source.tree):
            if isinstance(node, ast.Expr):
                yield from _of_expression(node.value, kinds, source, last.get(id(node)))
            elif isinstance(node, ast.Assign):
                yield from _of_assignment(node, kinds, source)
            elif isinstance(node, (ast.If, ast.While, ast.IfExp, ast.Assert)):
                test = asked.get(node.test.id) if isinstance(node.test, ast.Name) else None
                if test is not None and isinstance(node.test, ast.Name):
                    text = f"{node.test.id} is the function {ast.unparse(test)}, and always counts as true"
                    yield CodeWarning(source.at(node.test), text, f"Write {node.test.id} = {ast.unparse(test)}()")
                if isinstance(node.test, ast.Call) and normalized(last_name(node.test.func)) == "getpov":
                    written, text = ast.unparse(node.test), "is -1 if nothing is pressed, which counts as true"
                    yield CodeWarning(
                        source.at(node.test), f"{written} {text}", f"Write {written} == 0 for up, 90 for right"
                    )
                for each in _conditions(node.test):
                    name = last_name(each)
                    written = ast.unparse(each)
                    # Another library's object may have a value of the same name, but hardly one such as getAngle.
                    if written != f"self.{name}" and not _ASKS.match(name):
                        continue
                    if name in methods or (name not in assigned and name in _library_methods()):
                        text = f"{written} is a function, which counts as true whatever it would return"
                        yield CodeWarning(source.at(each), text, f"Write {written}()")
            elif isinstance(node, ast.Compare) and (joined := joined_by_bits(node)):
                yield CodeWarning(source.at(node), *joined)
            elif isinstance(node, ast.Call):
                yield from _of_call(node, source)
            elif isinstance(node, ast.FunctionDef) and node.name in ("isFinished", "is_finished"):
                inside = {type(each) for each in ast.walk(node)}
                if ast.Call in inside and not inside & {ast.Return, ast.Raise}:
                    text = f"{node.name} returns nothing, so the command never ends by itself"
                    yield CodeWarning(source.at(node), text, "Write return before what it computes.")
        yield from _replaced_methods(source)


def _nodes(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a file, without those where an error is expected."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Try) and child.handlers:
            continue
        if isinstance(child, ast.With) and any(
            isinstance(item.context_expr, ast.Call) and last_name(item.context_expr.func) in _EXPECTING
            for item in child.items
        ):
            continue
        yield child
        yield from _nodes(child)


def _of_expression(
    value: ast.expr, kinds: Kinds, source: Source, around: ast.FunctionDef | None
) -> Iterator[CodeWarning]:
    """Yield what is wrong with an expression that is a statement of its own."""
    written = ast.unparse(value)
    if isinstance(value, ast.Compare):
        is_equal = isinstance(value.ops[0], ast.Eq) and len(value.ops) == 1
        change = f"To set it, write one =: {ast.unparse(value.left)} = ..." if is_equal else "Write if before it."
        text = "this comparison does nothing: no one looks at its result"
        yield CodeWarning(source.at(value), text, f"Write assert {written}" if source.is_test else change)
    elif isinstance(value, ast.Attribute) or (
        isinstance(value, ast.Name) and isfunction(vars(source.module).get(value.id))
    ):
        yield CodeWarning(source.at(value), f"{written} does nothing: it is not called", f"Write {written}()")
    elif isinstance(value, ast.BinOp) and isinstance(value.op, (ast.Add, ast.Sub, ast.Mult, ast.Div)):
        text = f"{written} is computed, and nothing is done with it"
        yield CodeWarning(source.at(value), text, f"To set it, write: {ast.unparse(value.left)} = {written}")
    elif isinstance(value, ast.Call) and kinds.only_returns(value, source):
        if around is not None and not any(isinstance(each, ast.Return) for each in ast.walk(around)):
            if around.name not in names.OF_MODES | names.OF_A_COMMAND:
                text = f"{around.name}() computes {written}, and returns nothing"
                yield CodeWarning(source.at(value), text, f"Write return {written}")
            if around.name not in names.OF_MODES:
                return
        text = f"{written} returns a value, and nothing is done with it"
        name = ast.unparse(value.args[0]) if value.args and isinstance(value.args[0], (ast.Name, ast.Attribute)) else ""
        keeps = name and isinstance(kinds.called(value, source), BuiltinFunctionType) and "." not in name
        remedy = f"Write {name} = {written}" if keeps else f"Write result = {written}, and use result"
        yield CodeWarning(source.at(value), text, remedy)


def _of_assignment(node: ast.Assign, kinds: Kinds, source: Source) -> Iterator[CodeWarning]:
    """Yield ``speed =+ 1``."""
    value, target = node.value, node.targets[0]
    if isinstance(target, ast.Attribute) and (owner := kinds.of(target.value, source)) is not None:
        setter = f"set{target.attr[:1].upper()}{target.attr[1:]}"
        if hasattr(owner, setter) and not hasattr(owner, target.attr) and last_name(target.value) != "self":
            written = f"{ast.unparse(target.value)}.{setter}({ast.unparse(value)})"
            yield CodeWarning(
                source.at(node), f"{ast.unparse(target)} is a new name, which nothing reads", f"Write {written}"
            )
    if not isinstance(value, ast.UnaryOp) or not isinstance(value.op, (ast.UAdd, ast.USub)):
        return
    sign = "+" if isinstance(value.op, ast.UAdd) else "-"
    joined = value.lineno == target.end_lineno and value.col_offset - (target.end_col_offset or 0) in (1, 2)
    if joined and (sign == "+" or value.operand.col_offset > value.col_offset + 1):
        text = f"={sign} sets {ast.unparse(target)} to {ast.unparse(value)}, and does not change it by that"
        yield CodeWarning(source.at(node), text, f"Write {ast.unparse(target)} {sign}= {ast.unparse(value.operand)}")


def _of_call(call: ast.Call, source: Source) -> Iterator[CodeWarning]:
    """Yield ``(one and other).onTrue(...)`` of triggers."""
    bound = call.func.value if isinstance(call.func, ast.Attribute) and call.func.attr in BINDINGS else None
    if isinstance(bound, ast.BoolOp):
        word, sign = ("and", "&") if isinstance(bound.op, ast.And) else ("or", "|")
        written = f" {sign} ".join(map(ast.unparse, bound.values))
        text = f"{word} takes one of the triggers, and does not combine them"
        yield CodeWarning(source.at(call), text, f"Write ({written}).{last_name(call.func)}(...)")
    if call.args and _BUTTON.fullmatch(last_name(call.func)):
        number, first = call.args[-1], CURRENT.first_button
        if isinstance(number, ast.Constant) and type(number.value) is int and not first <= number.value < first + 32:
            text = f"there is no button {number.value}: buttons are {first} to {first + 31}, so it is never pressed"
            yield CodeWarning(source.at(call), text, "Write the button's number, or use a method such as getAButton().")


def _conditions(test: ast.expr) -> Iterator[ast.expr]:
    """Yield the attributes whose truth a condition asks for, or that it compares with a constant."""
    if isinstance(test, ast.BoolOp):
        for each in test.values:
            yield from _conditions(each)
    elif isinstance(test, ast.UnaryOp):
        yield from _conditions(test.operand)
    elif isinstance(test, ast.Compare) and all(
        isinstance(each, ast.Constant) and each.value is not None for each in test.comparators
    ):
        yield from _conditions(test.left)
    elif isinstance(test, ast.Attribute):
        yield test


def _replaced_methods(source: Source) -> Iterator[CodeWarning]:
    """Yield ``self.isFinished = True`` in a class that has a method of this name."""
    for definition in (each for each in source.tree.body if isinstance(each, ast.ClassDef)):
        cls = vars(source.module).get(definition.name)
        for node in ast.walk(definition):
            if not isinstance(node, ast.Assign) or not isinstance(node.value, ast.Constant) or node.value.value is None:
                continue
            for target in node.targets:
                if ast.unparse(target).startswith("self.") and isroutine(getattr(cls, last_name(target), None)):
                    name = last_name(target)
                    text = f"{ast.unparse(node)} replaces the method {name}: what calls it fails"
                    remedy = f"Choose another name, or call it: {ast.unparse(target)}(...)"
                    yield CodeWarning(source.at(node), text, remedy)


def _assigned(tree: ast.Module) -> Iterator[str]:
    """Yield the names to which a file assigns something, and those of its properties."""
    for node in ast.walk(tree):
        if isinstance(node, (ast.Attribute, ast.Name)) and isinstance(node.ctx, ast.Store):
            yield last_name(node)
        elif isinstance(node, ast.FunctionDef) and node.decorator_list:
            yield node.name


def _methods(tree: ast.Module) -> Iterator[str]:
    for cls in (each for each in ast.walk(tree) if isinstance(each, ast.ClassDef)):
        yield from (each.name for each in cls.body if isinstance(each, ast.FunctionDef))


@cache
def _library_methods() -> frozenset[str]:
    """Return the names that are methods in each class of the robot's libraries that has them."""
    found: dict[str, bool] = {}
    for module in [each for name, each in list(sys.modules.items()) if name.partition(".")[0] in names.LIBRARIES]:
        for cls in [each for each in vars(module).values() if isinstance(each, type)]:
            for name, value in list(vars(cls).items()):
                found[name] = found.get(name, True) and callable(value) and not isinstance(value, type)
    return frozenset(name for name, is_method in found.items() if is_method)
