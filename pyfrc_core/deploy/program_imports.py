"""The modules that a robot program imports, from its source.

The program's files are read in the order of their imports, from the main file on. Files that the program does not
import, such as tests and physics, are ignored.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ..file_hash import open_file

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


#: The start of a statement that does not belong to the previous one.
_NEXT_STATEMENT = re.compile(rb"^(?!except|else|elif|finally|case)[A-Za-z_@]", re.MULTILINE)


@dataclass(frozen=True)
class FoundImport:
    """An import and its file."""

    file: str
    wanted: Import

    @property
    def where(self) -> str:
        return f"{self.file}:{self.wanted.line}"


class ProgramImports:
    """The imports of a program.

    :param files: the program's files by path, relative to its directory and with forward slashes
    :param main:  the path of its main file
    """

    def __init__(self, files: Mapping[str, Path], main: str) -> None:
        self._files = files
        self._directories = {above for path in files for above in _above(path) if path.endswith((".py", ".so"))}
        self._extensions: dict[str, list[str]] = {}
        for path in files:
            if path.endswith((".so", ".pyd")):
                directory, slash, name = path.rpartition("/")
                self._extensions.setdefault(f"{directory}{slash}{name.partition('.')[0]}", []).append(path)
        #: Source files that are always imported when the program starts.
        self.certain: set[str] = set()
        #: Imports that the program's own files do not provide, but the robot's Python may.
        self.outside: list[FoundImport] = []
        #: Imports of modules that are missing in the program's own packages.
        self.lost: list[FoundImport] = []
        #: Whether the program changes `sys.path`.
        self.changes_path = False
        self._read: set[tuple[str, bool]] = set()
        self._follow(main)

    def file_of(self, module: str) -> str | None:
        """Return the program's own source file of a module."""
        base = module.replace(".", "/")
        return next((each for each in (f"{base}/__init__.py", f"{base}.py") if each in self._files), None)

    def extensions_of(self, module: str) -> list[str]:
        """Return the program's own extension modules of this name, for any version of Python."""
        return self._extensions.get(module.replace(".", "/"), [])

    def is_own_directory(self, module: str) -> bool:
        """Return whether the program has a directory of this name with code."""
        return module.replace(".", "/") in self._directories

    def named_alike(self, module: str) -> bool:
        """Return whether any directory of the program has a module of this name."""
        ends = (f"/{module}.py", f"/{module}/__init__.py")
        return any(each.endswith(ends) for each in self._files)

    def _follow(self, main: str) -> None:
        waiting = [(main, True)]
        while waiting:
            path, certain = waiting.pop()
            if (path, True) in self._read or (path, certain) in self._read or path not in self._files:
                continue
            again = (path, False) in self._read
            self._read.add((path, certain))
            if certain:
                self.certain.add(path)
            source = _source_of(self._files[path])
            if again:  # now known to be certain
                self.outside = [each for each in self.outside if each.file != path]
                self.lost = [each for each in self.lost if each.file != path]
            self.changes_path = self.changes_path or b"sys.path" in source
            package = path.removesuffix(".py").removesuffix("__init__").rstrip("/")
            package = package if path.endswith("/__init__.py") else package.rpartition("/")[0]
            for each in imports_in(_parsed(source), package.replace("/", ".")):
                found = replace(each, certain=each.certain and certain)
                waiting += [(own, found.certain) for own in self._own_files(FoundImport(path, found))]

    def _own_files(self, found: FoundImport) -> Iterator[str]:
        """Yield the program's files that an import runs. Add other modules to `outside` or `lost`."""
        wanted = found.wanted
        parts = wanted.module.split(".")
        if parts[0] == "":
            self.lost.append(found)
            return
        if self.file_of(parts[0]) is None and not self.is_own_directory(parts[0]):
            self.outside.append(found)
            return
        module = ""
        for part in parts:
            module = f"{module}.{part}" if module else part
            file = self.file_of(module)
            if file is not None:
                yield file
            elif not self.is_own_directory(module):
                if not self.extensions_of(module):
                    self.lost.append(replace(found, wanted=replace(wanted, module=module, names=())))
                return
        if self.file_of(module) is None:
            # A directory without __init__.py: a package of this name on the robot takes precedence.
            self.outside.append(found)
        for name in wanted.names:
            file = self.file_of(f"{module}.{name}")
            if file is not None:
                yield file
            elif self.file_of(module) is None and name != "*" and not self._has(f"{module}.{name}"):
                self.lost.append(replace(found, wanted=replace(wanted, module=f"{module}.{name}", names=())))

    def _has(self, module: str) -> bool:
        return self.is_own_directory(module) or bool(self.extensions_of(module))


def _above(path: str) -> Iterator[str]:
    directory = path.rpartition("/")[0]
    while directory:
        yield directory
        directory = directory.rpartition("/")[0]


def _source_of(file: Path) -> bytes:
    try:
        with open_file(file) as stream:
            return stream.read()
    except OSError:
        return b""


def _parsed(source: bytes) -> ast.Module:
    """Parse a file up to its last import, which is usually a small part of it.

    A file with invalid syntax has no imports here. The tests and the robot report it.
    """
    last = source.rfind(b"import")
    if last >= 0:
        rest = _NEXT_STATEMENT.search(source, last + len("import"))
        for part in dict.fromkeys((source[: rest.start()] if rest else source, source)):
            try:
                # A cut within a string or brackets gives invalid syntax; then the whole file is parsed.
                return ast.parse(part)
            except (SyntaxError, ValueError, RecursionError, MemoryError):
                continue
    return ast.Module([], [])
