"""Find files of a robot project that hide a library: ``import random`` then imports the project's `random.py`.

Checked before a command runs the robot, since the resulting error is cryptic and often raised in library code.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.machinery import FrozenImporter, PathFinder
from pathlib import Path

from ..errors import ProjectError

#: Libraries that robots, their tests or pyfrc import. Only installed ones are checked.
LIBRARIES = frozenset(
    {
        *("commands2", "cscore", "cv2", "hal", "magicbot", "navx", "ntcore", "numpy", "pathplannerlib"),
        *("phoenix5", "phoenix6", "photonlibpy", "pint", "pyfrc", "pyfrc_cli", "pyfrc_core", "rev", "robotpy"),
        *("robotpy_apriltag", "robotpy_ext", "urcl", "wpilib", "wpimath", "wpinet", "wpiutil"),
        *("_pytest", "attr", "attrs", "click", "coverage", "cryptography", "hypothesis", "iniconfig"),
        *("packaging", "paramiko", "pluggy", "pydantic", "pydantic_core", "pygments", "pytest"),
        *("rich", "scipy", "sortedcontainers", "tomli", "typing_extensions", "PIL", "exceptiongroup"),
    }
)

#: Standard modules that no library imports: a project may have a `turtle.py` of its own.
RARELY_IMPORTED = frozenset(
    {
        *("aifc", "antigravity", "asynchat", "asyncore", "audioop", "cgi", "cgitb", "chunk", "colorsys", "crypt"),
        *("curses", "dbm", "ensurepip", "idlelib", "imaplib", "imghdr", "lib2to3", "mailbox", "mailcap", "msilib"),
        *("netrc", "nis", "nntplib", "ossaudiodev", "pipes", "poplib", "pyclbr", "sched", "shelve", "smtpd"),
        *("smtplib", "sndhdr", "spwd", "sunau", "symtable", "tabnanny", "telnetlib", "this", "turtle", "turtledemo"),
        *("uu", "venv", "wave", "winsound", "wsgiref", "xdrlib", "xmlrpc", "zipapp"),
    }
)


@dataclass(frozen=True)
class HiddenLibrary:
    """A file or package of the project with the name of a library.

    :param name: the file, relative to the project: ``random.py`` or ``wpilib/__init__.py``
    """

    name: str
    library: str

    @property
    def text(self) -> str:
        """The problem in one sentence."""
        if self.library in sys.builtin_module_names or FrozenImporter.find_spec(self.library) is not None:
            return f"{self.name} has the name of a library: import {self.library} finds that, never this file"
        return f"{self.name} hides a library: import {self.library} finds it instead"

    @property
    def remedy(self) -> str:
        """The remedy in one sentence."""
        return f"Give {self.name if self.name.endswith(f'{self.library}.py') else self.library + '/'} another name."


def find_hidden_libraries(root: Path, main_file: Path | None = None) -> Iterator[HiddenLibrary]:
    """Yield the files of the project in `root` that hide a library, sorted by name.

    :param main_file: the robot's file, which may have any name
    """
    for library, file in _modules_of(root):
        if file != main_file and _is_library(library, root):
            yield HiddenLibrary(file.relative_to(root).as_posix(), library)


def refuse_hidden_libraries(root: Path, main_file: Path | None = None) -> None:
    """:raises ProjectError: when the project hides a library that something imports"""
    found = list(find_hidden_libraries(root, main_file))
    if found:
        more = f"; and so do: {', '.join(each.name for each in found[1:])}" if len(found) > 1 else ""
        raise ProjectError(f"{found[0].text}{more}", remedy=found[0].remedy)


def find_hidden_by_any_name(root: Path, main_file: Path | None = None) -> Iterator[HiddenLibrary]:
    """Yield files that hide any installed module, to explain an import that failed."""
    for library, file in _modules_of(root):
        if file != main_file and library != "tests" and (_is_library(library, root) or _is_installed(library, root)):
            yield HiddenLibrary(file.relative_to(root).as_posix(), library)


def _modules_of(root: Path) -> list[tuple[str, Path]]:
    """Return the modules and packages in the project's directory; directories without `__init__.py` hide nothing."""
    found: dict[str, Path] = {}
    try:
        entries = sorted(root.iterdir())
    except OSError:
        return []
    for entry in entries:
        if entry.suffix == ".py" and entry.is_file():
            found.setdefault(entry.stem, entry)
        elif entry.name.isidentifier() and (entry / "__init__.py").is_file():
            found[entry.name] = entry / "__init__.py"
    return list(found.items())


def _is_library(name: str, root: Path) -> bool:
    if name in sys.stdlib_module_names:
        return name not in RARELY_IMPORTED
    return name in LIBRARIES and _is_installed(name, root)


def _is_installed(name: str, root: Path) -> bool:
    elsewhere = [place for place in sys.path if place and Path(place).resolve() != root.resolve()]
    loaded = getattr(sys.modules.get(name), "__file__", None)
    if loaded is not None and not Path(loaded).is_relative_to(root):
        return True
    spec = PathFinder.find_spec(name, elsewhere)
    return spec is not None and spec.origin is not None
