"""One walk over a project's files for everything that looks at them, and one way to read a Python file.

What is left out cannot matter: version control, environments, caches of tools, and what pyfrc writes itself.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator
from contextlib import suppress
from importlib.util import decode_source
from pathlib import Path

from ..encoding import why_not_utf8
from ..errors import PyfrcError
from ..file_hash import open_file
from .environments import is_environment
from .robot_files import RobotFiles

#: Version control, installed packages, state and caches of tools, and `.pyfrc`, which is pyfrc's own.
LEFT_OUT = frozenset(
    {".git", ".hg", ".jj", ".svn", "node_modules", ".pyfrc"}
    | {"__pycache__", ".hypothesis", ".idea", ".mypy_cache", ".nox", ".pytest_cache", ".ruff_cache", ".tox"}
)


class SourceError(PyfrcError):
    """A Python file cannot be read.

    :param line: the first line that cannot be read, from 1; None when it is the whole file
    """

    def __init__(self, message: str, file: str | Path, remedy: str, line: int | None = None) -> None:
        self.file, self.line = file, line
        super().__init__(message, where=f"{file}:{line}" if line else file, remedy=remedy)

    def within(self, files: RobotFiles) -> SourceError:
        """Return this error with the file's path as the user sees it."""
        path = Path(files.relative(str(self.file))).as_posix()
        return SourceError(self.message, path, self.remedy or "", self.line)


def files_below(top: Path, hidden: bool = True) -> Iterator[Path]:
    """Yield all files below a directory, through links too, and directories whose name is that of a Python file.

    Each directory is read once, under its own name if it has one here, so that a circle of links ends. What cannot be
    read, and links to nothing, are among the files.

    :param hidden: with files and directories whose name begins with a dot
    """
    directories, links, seen = [top], list[Path](), set[tuple[int, int]]()
    while directories or links:
        directory = directories.pop() if directories else links.pop(0)
        try:
            status = directory.stat()
            if (status.st_dev, status.st_ino) in seen:
                continue
            seen.add((status.st_dev, status.st_ino))
            with os.scandir(directory) as entries:
                found = sorted(entries, key=lambda each: each.name)
        except OSError:  # nothing in it can be read
            continue
        for entry in found:
            if entry.name.startswith(".") and not hidden:
                continue
            path = Path(entry.path)
            try:
                is_directory = entry.is_dir()
            except OSError:  # a link to itself
                is_directory = False
            if not is_directory or path.suffix == ".py":
                yield path
            if is_directory and entry.name not in LEFT_OUT and not is_environment(path):
                (links if entry.is_symlink() else directories).append(path)


def python_files(top: Path) -> list[Path]:
    """Return what is called ``*.py`` below a directory, sorted, and is neither hidden nor in installed packages."""
    found = (each for each in files_below(top, hidden=False) if each.suffix == ".py")
    return sorted(each for each in found if "site-packages" not in each.relative_to(top).parts)


def read_source(file: Path) -> str:
    """Return the text of a Python file, as Python reads it.

    :raises SourceError: if it cannot be read, with the reason
    """
    try:
        if file.is_dir():
            raise SourceError("this is a directory, with the name of a Python file", file, "Rename it.")
        with open_file(file) as stream:
            content = stream.read()
    except OSError as error:
        if file.is_symlink() and not file.exists():
            gone = f"this is a link to {os.readlink(file)}, which does not exist"  # noqa: PTH115 - as it is written
            raise SourceError(gone, file, "Remove it, or correct it.") from None
        why = error.strerror or str(error)
        message = why if why.startswith("this is") else f"this cannot be read: {why}"
        raise SourceError(message, file, "Check its owner and permissions, or remove it.") from None
    try:
        text = decode_source(content)  # an encoding may be named in its first line
        if "\0" not in text:
            return text
    except (SyntaxError, UnicodeDecodeError):
        pass
    if b"\0" not in content:
        with suppress(SyntaxError, ValueError):  # in comments, an import lets any byte pass
            ast.parse(content)
            return content.decode("utf-8", "replace")
    wrong = why_not_utf8(content)
    if wrong is None:
        raise SourceError("this is not in the encoding that its first line names", file, "Save it as UTF-8.")
    raise SourceError(wrong.message, file, wrong.remedy, wrong.line)


def text_to_search(file: Path) -> str:
    """Return what can be read of a Python file as UTF-8, a replacement for each wrong byte; empty if nothing can."""
    try:
        return file.read_text("utf-8", "replace") if file.is_file() else ""
    except OSError:
        return ""


def why_unreadable(file: Path) -> SourceError | None:
    """Return the error of `read_source`, if there is one."""
    try:
        read_source(file)
    except SourceError as error:
        return error
    return None
