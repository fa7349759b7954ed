"""Which modules a robot program imports, found in its source without running it.

The program's files are read in the order in which Python would import them, from the main file on. So files that the
program does not use, such as tests and physics, ask nothing of the robot.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from .import_statements import Import, imports_in

#: Where a statement begins that does not belong to the one before.
_NEXT_STATEMENT = re.compile(rb"^(?!except|else|elif|finally|case)[A-Za-z_@]", re.MULTILINE)


@dataclass(frozen=True)
class FoundImport:
    """An import, and the file that it is in."""

    file: str
    wanted: Import

    @property
    def where(self) -> str:
        return f"{self.file}:{self.wanted.line}"


class ProgramImports:
    """What a program imports.

    :param files: the program's files by their paths relative to its directory, with forward slashes
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
        #: The source files that are imported for certain when the program starts.
        self.certain: set[str] = set()
        #: Imports that the program's own files do not provide: the robot's Python may.
        self.outside: list[FoundImport] = []
        #: Imports of something that the program's own package does not have.
        self.lost: list[FoundImport] = []
        #: Whether the program looks for modules in further directories.
        self.changes_path = False
        self._read: set[tuple[str, bool]] = set()
        self._follow(main)

    def file_of(self, module: str) -> str | None:
        """Return the program's own source file of a module."""
        base = module.replace(".", "/")
        return next((each for each in (f"{base}/__init__.py", f"{base}.py") if each in self._files), None)

    def extensions_of(self, module: str) -> list[str]:
        """Return the program's own extension modules of this name, for whatever Python they are."""
        return self._extensions.get(module.replace(".", "/"), [])

    def is_own_directory(self, module: str) -> bool:
        """Return whether it is a directory of the program's with code, but without ``__init__.py``."""
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
        """The program's files that an import runs; what is not the program's own is put with `outside` or `lost`."""
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
            # A directory alone: the robot may have a package of this name, which then comes first.
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
        return file.read_bytes()
    except OSError:
        return b""


def _parsed(source: bytes) -> ast.Module:
    """Parse a file as far as there are imports in it, which mostly is a tenth of it.

    Nothing is known of a file that this Python cannot read: the tests, and the robot, say so.
    """
    last = source.rfind(b"import")
    if last >= 0:
        rest = _NEXT_STATEMENT.search(source, last + len("import"))
        for part in dict.fromkeys((source[: rest.start()] if rest else source, source)):
            try:
                # What is cut within a string, or in a bracket, is no valid source: then the whole is parsed.
                return ast.parse(part)
            except (SyntaxError, ValueError, RecursionError, MemoryError):
                continue
    return ast.Module([], [])
