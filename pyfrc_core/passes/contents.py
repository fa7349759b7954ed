"""What a run of a project's tests reads: the project's files, the installed packages, and Python itself."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from .._version import __version__
from ..file_hash import hash_file
from ..project import Project
from ..project.environments import is_environment
from ..project.loaded_modules import PACKAGES, loaded_modules

#: Directories and files that the robot, its tests or other tools write, and no test reads.
_DIRECTORIES_WRITTEN = {"__pycache__", "build", "ctre_sim", "dist", "htmlcov"}
_FILES_WRITTEN = {"coverage.xml", "networktables.json", "networktables.json.bck", "simgui-ds.json", "simgui.json"}
_SUFFIXES_WRITTEN = (".hoot", ".pyc", ".rrd", ".wpilog")
#: The length of a hash, in hexadecimal.
_HASH_LETTERS = 24


@dataclass(frozen=True)
class Contents:
    """The files of a project, each with a hash of its content, by its path relative to the project.

    :param sources: those in Python, tests included
    :param others:  all others: settings, paths, field layouts
    """

    sources: dict[str, str]
    others: dict[str, str]

    def differences(self, other: Contents) -> list[str]:
        """Return the paths of the files that are not the same in both."""
        mine, others = {**self.sources, **self.others}, {**other.sources, **other.others}
        return sorted(path for path in mine.keys() | others.keys() if mine.get(path) != others.get(path))


def read_contents(project: Project, written: Iterable[Path] = ()) -> Contents:
    """Return the project's current contents. Hidden files, environments and what runs write are left out.

    :param written: further directories that runs write
    """
    left_out = {path.absolute() for path in written}
    contents = Contents({}, {})
    for file in project_files(project, left_out):
        kind = contents.sources if file.suffix == ".py" else contents.others
        kind[Path(os.path.relpath(file, project.root)).as_posix()] = hash_of_file(file)
    return contents


def project_files(project: Project, left_out: Collection[Path] = ()) -> Iterator[Path]:
    """Yield the project's files. Hidden files, environments and what runs write are left out.

    :param left_out: absolute directories that are left out, too
    """
    beside = project.test_directories[1]
    yield from _files_below(project.root, left_out)
    if not beside.is_relative_to(project.root) and beside.is_dir():
        yield from _files_below(beside, left_out)
    if project.pyproject.parent != project.root and project.pyproject.is_file():
        yield project.pyproject


def _files_below(directory: Path, left_out: Collection[Path]) -> Iterator[Path]:
    for place, directories, files in os.walk(directory):
        directories[:] = sorted(
            name
            for name in directories
            if not name.startswith(".")
            and name not in _DIRECTORIES_WRITTEN
            and not is_environment(Path(place, name))
            and Path(place, name) not in left_out
        )
        for name in files:
            if not name.startswith(".") and name not in _FILES_WRITTEN and not name.endswith(_SUFFIXES_WRITTEN):
                yield Path(place, name)


def hash_of_file(file: Path) -> str:
    """Return a hash of the file's content; of a file that cannot be read, one that no content has."""
    try:
        return hash_file(file)[0][:_HASH_LETTERS]
    except OSError:
        return "unreadable"


def version_of_file(file: Path) -> str:
    """Return the size of a file outside the project and the time of its last change, as of an installed package.

    Not its hash: these may be hundreds of files, where pyfrc itself is installed as an editable package.
    """
    try:
        status = file.stat()
    except OSError:
        return "unreadable"
    return f"{status.st_size} {status.st_mtime_ns}"


def hash_of(content: bytes) -> str:
    """Return a hash of the content."""
    return sha256(content).hexdigest()[:_HASH_LETTERS]


def environment() -> str:
    """Return a hash of Python, pyfrc's version and the installed packages.

    A package that is installed again counts as changed, also with the same version. The files of editable packages
    count as `loaded_from_elsewhere`.
    """
    facts = [sys.version, platform.machine(), platform.system(), __version__]
    for place in sys.path:
        if place.endswith(PACKAGES):
            try:
                with os.scandir(place) as entries:
                    facts += sorted(
                        f"{each.name} {each.stat().st_mtime_ns}"
                        for each in entries
                        if each.name.endswith((".dist-info", ".egg-info", ".egg-link", ".pth"))
                    )
            except OSError:
                continue
    return hash_of("\n".join(facts).encode())


def loaded_from_elsewhere(project: Project) -> set[str]:
    """Return the source files that this process has imported from outside the project, Python and its packages."""
    is_ours = project.files.is_project_file
    files = {str(module.__file__) for module in loaded_modules.look() if module.__name__ != "__main__"}
    return {file for file in files if not is_ours(file)}.union(loaded_modules.files_of_pyfrc())
