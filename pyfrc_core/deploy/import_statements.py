"""The import statements of a file, and whether a robot executes them."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

#: Functions that WPILib calls only in simulation.
_SIMULATION_ONLY = {"simulationInit", "simulationPeriodic", "_simulationInit", "_simulationPeriodic"}
_IMPORT_ERRORS = {"ImportError", "ModuleNotFoundError", "Exception", "BaseException"}


@dataclass(frozen=True)
class Import:
    """An imported module.

    :param module:  its dotted name, with leading dots for a relative import above the program's directory
    :param names:   imported names, which may be submodules
    :param line:    the line in its file
    :param certain: whether a robot always executes the import when it imports the file
    :param instead: modules that it replaces; it is needed only if one of them is missing
    """

    module: str
    names: tuple[str, ...]
    line: int
    certain: bool = True
    instead: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Context:
    certain: bool = True
    optional: bool = False
    instead: tuple[str, ...] = ()


def imports_in(tree: ast.Module, package: str) -> list[Import]:
    """Return the imports of a file, without optional imports and those that a robot never executes.

    :param package: the dotted name of its package; empty for the program's top directory
    """
    return list(_imports(tree.body, package, _Context()))


def _imports(body: Iterable[ast.stmt], package: str, context: _Context) -> Iterator[Import]:
    for statement in body:
        if isinstance(statement, (ast.Import, ast.ImportFrom)):
            if not context.optional:
                yield from _named(statement, package, context)
        elif isinstance(statement, ast.If):
            yield from _in_if(statement, package, context)
        elif isinstance(statement, (ast.FunctionDef, ast.AsyncFunctionDef)):
            if statement.name not in _SIMULATION_ONLY:
                yield from _imports(statement.body, package, replace(context, certain=False))
        elif isinstance(statement, ast.Try):
            yield from _in_try(statement, package, context)
        elif sys.version_info >= (3, 11) and isinstance(statement, ast.TryStar):
            yield from _imports(statement.body, package, replace(context, certain=False))
        elif isinstance(statement, (ast.With, ast.AsyncWith)):
            suppressed = any(_suppresses_import_errors(item.context_expr) for item in statement.items)
            yield from _imports(statement.body, package, replace(context, optional=context.optional or suppressed))
        elif isinstance(statement, ast.Match):
            for case in statement.cases:
                yield from _imports(case.body, package, replace(context, certain=False))
        elif isinstance(statement, (ast.ClassDef, ast.For, ast.AsyncFor, ast.While)):
            yield from _imports(statement.body, package, context)
            yield from _imports(getattr(statement, "orelse", ()), package, context)


def _named(statement: ast.Import | ast.ImportFrom, package: str, context: _Context) -> Iterator[Import]:
    line, certain, instead = statement.lineno, context.certain, context.instead
    if isinstance(statement, ast.Import):
        for each in statement.names:
            yield Import(each.name, (), line, certain, instead)
        return
    module = statement.module or ""
    if statement.level:
        above = package.split(".") if package else []
        kept = len(above) - (statement.level - 1)
        if kept <= 0:
            module = "." * statement.level + module
        else:
            module = ".".join([*above[:kept], *([module] if module else [])])
    yield Import(module, tuple(each.name for each in statement.names), line, certain, instead)


def _in_if(statement: ast.If, package: str, context: _Context) -> Iterator[Import]:
    truth = _on_robot(statement.test)
    if truth is not None:
        yield from _imports(statement.body if truth else statement.orelse, package, context)
        return
    perhaps = replace(context, certain=False)
    one = list(_imports(statement.body, package, perhaps))
    other = list(_imports(statement.orelse, package, perhaps))
    for imports, others in ((one, other), (other, one)):
        modules = tuple(each.module for each in others)
        yield from (replace(each, instead=each.instead or modules) for each in imports)


def _in_try(statement: ast.Try, package: str, context: _Context) -> Iterator[Import]:
    caught = [each for each in statement.handlers if _catches_import_errors(each)]
    optional = any(not any(isinstance(each, ast.Raise) for each in handler.body) for handler in caught)
    body = list(_imports(statement.body, package, context))
    if not optional:
        yield from body
    tried = tuple(each.module for each in body)
    for handler in statement.handlers:
        within = replace(context, instead=context.instead or tried) if handler in caught else context
        within = within if handler in caught and tried else replace(within, certain=False)
        yield from _imports(handler.body, package, within)
    # Executed only if all imports of the body succeed.
    yield from _imports(statement.orelse, package, replace(context, certain=context.certain and not optional))
    yield from _imports(statement.finalbody, package, context)


def _catches_import_errors(handler: ast.ExceptHandler) -> bool:
    if handler.type is None:
        return True
    types = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return any(_last_name(each) in _IMPORT_ERRORS for each in types)


def _suppresses_import_errors(call: ast.expr) -> bool:
    return (
        isinstance(call, ast.Call)
        and _last_name(call.func) == "suppress"
        and any(_last_name(each) in _IMPORT_ERRORS for each in call.args)
    )


def _last_name(expression: ast.expr) -> str | None:
    if isinstance(expression, ast.Attribute):
        return expression.attr
    return expression.id if isinstance(expression, ast.Name) else None


def _on_robot(test: ast.expr) -> bool | None:
    """Return the value of a condition on a robot, or None if it is unknown."""
    if isinstance(test, ast.Constant):
        return bool(test.value)
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        truth = _on_robot(test.operand)
        return None if truth is None else not truth
    if isinstance(test, ast.BoolOp):
        decisive = isinstance(test.op, ast.Or)
        truths = [_on_robot(each) for each in test.values]
        return decisive if decisive in truths else None if None in truths else not decisive
    if isinstance(test, ast.Call):
        return _call_on_robot(test)
    if isinstance(test, ast.Compare) and len(test.ops) == 1 and isinstance(test.comparators[0], ast.Constant):
        # The robot's Python imports the main file: `__name__` is never "__main__".
        actual = {"__name__": "", "sys.platform": "linux", "os.name": "posix"}.get(ast.unparse(test.left))
        if actual is not None and isinstance(test.ops[0], (ast.Eq, ast.NotEq)):
            return (actual == test.comparators[0].value) == isinstance(test.ops[0], ast.Eq)
    return False if _last_name(test) == "TYPE_CHECKING" else None


def _call_on_robot(call: ast.Call) -> bool | None:
    name = _last_name(call.func)
    if name in ("isSimulation", "isReal"):
        return name == "isReal"
    if name == "startswith" and ast.unparse(call.func) == "sys.platform.startswith" and call.args:
        start = call.args[0]
        if isinstance(start, ast.Constant) and isinstance(start.value, str):
            return "linux".startswith(start.value)
    return None
