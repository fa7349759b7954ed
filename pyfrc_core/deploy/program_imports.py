"""The modules that a robot program imports whenever it starts, from its source.

The program's files are read in the order of their imports, from the main file on. Files that the program does not
import, such as tests and physics, are ignored. So are imports in functions, and in `if`, `try` and other statements
with a block: whether a robot runs them is not known before it does.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from ..file_hash import open_file


@dataclass(frozen=True)
class Import:
    """An imported module.

    :param module: its dotted name, with leading dots for a relative import above the program's directory
    :param names:  imported names, which may be submodules
    :param line:   the line in its file
    """

    module: str
    names: tuple[str, ...]
    line: int


def imports_in(body: Iterable[ast.stmt], package: str) -> Iterator[Import]:
    """Yield the imports of a file that always run, at its top level and in the bodies of classes.

    :param package: the dotted name of its package; empty for the program's top directory
    """
    for statement in body:
        if isinstance(statement, ast.ClassDef):
            yield from imports_in(statement.body, package)
        elif isinstance(statement, ast.Import):
            yield from (Import(each.name, (), statement.lineno) for each in statement.names)
        elif isinstance(statement, ast.ImportFrom):
            names = tuple(each.name for each in statement.names)
            yield Import(_source_module(statement, package), names, statement.lineno)


def _source_module(statement: ast.ImportFrom, package: str) -> str:
    module, level = statement.module or "", statement.level
    above = package.split(".") if package else []
    kept = len(above) - (level - 1)
    if level == 0:
        return module
    if kept <= 0:
        return "." * level + module
    return ".".join([*above[:kept], *([module] if module else [])])


#: The start of a statement that does not belong to the previous one.
_NEXT_STATEMENT = re.compile(rb"^(?!except|else|elif|finally|case)[A-Za-z_@]", re.MULTILINE)


@dataclass(frozen=True)
class FoundImport:
    """An import of a module that is not the program's, and its file."""

    file: str
    line: int
    module: str


class ProgramImports:
    """The imports of a program.

    :param files: the program's files by path, relative to its directory and with forward slashes
    :param main:  the path of its main file
    """

    def __init__(self, files: Mapping[str, Path], main: str) -> None:
        self._files = files
        #: The names of modules, packages and directories with code at the top of the program.
        self._own = {re.split(r"[./]", path)[0] for path in files if path.endswith((".py", ".so", ".pyd"))}
        #: Source files that are always imported when the program starts.
        self.read: set[str] = set()
        #: Imports that the program's own files do not provide, but the robot's Python may.
        self.outside: list[FoundImport] = []
        changes_path = False
        waiting = [main]
        while waiting:
            path = waiting.pop()
            if path in self.read or path not in self._files:
                continue
            self.read.add(path)
            source = _source_of(self._files[path])
            changes_path = changes_path or b"sys.path" in source
            package = path.removesuffix(".py").removesuffix("__init__").rstrip("/")
            package = package if path.endswith("/__init__.py") else package.rpartition("/")[0]
            for each in imports_in(_parsed(source).body, package.replace("/", ".")):
                top = each.module.partition(".")[0]
                if top in self._own:
                    waiting += self._own_files(each)
                elif top:
                    self.outside.append(FoundImport(path, each.line, each.module))
        if changes_path:  # they are probably in a directory that the program adds to it
            self.outside = [each for each in self.outside if not self._is_named_alike(each.module.partition(".")[0])]

    def _file_of(self, module: str) -> str | None:
        """Return the program's own source file of a module."""
        base = module.replace(".", "/")
        return next((each for each in (f"{base}/__init__.py", f"{base}.py") if each in self._files), None)

    def _is_named_alike(self, module: str) -> bool:
        """Return whether any directory of the program has a module of this name."""
        ends = (f"/{module}.py", f"/{module}/__init__.py")
        return any(each.endswith(ends) for each in self._files)

    def _own_files(self, wanted: Import) -> Iterator[str]:
        """Yield the program's files that an import runs."""
        parts = wanted.module.split(".")
        modules = [".".join(parts[: count + 1]) for count in range(len(parts))]
        for each in (*modules, *(f"{wanted.module}.{name}" for name in wanted.names)):
            if (file := self._file_of(each)) is not None:
                yield file


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
