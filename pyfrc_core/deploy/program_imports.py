"""The modules that a robot program imports, from its source.

The program's files are read in the order of their imports, from the main file on. Files that the program does not
import, such as tests and physics, are ignored.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ..file_hash import open_file
from .import_statements import Import, imports_in

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
