"""Passed tests, kept in the project with hashes of what they have read.

A run of a project's tests reads the project's files, the installed packages, and Python itself.
"""

from __future__ import annotations

import json
import os
import platform
import sys
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import cache
from hashlib import sha256
from pathlib import Path, PurePath

from .._version import __version__
from ..config.settings import DEFAULT_SEED
from ..file_hash import hash_file
from ..project import TEST_FILES, Project
from ..project.environments import is_environment
from ..project.loaded_modules import PACKAGES, loaded_modules
from ..text_files import keep_out_of_version_control, write_whole

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


def version_of_file(file: str) -> str:
    """Return the size of a file outside the project and the time of its last change, as of an installed package.

    Not its hash: these may be hundreds of files, where pyfrc itself is installed as an editable package.
    """
    try:
        status = os.stat(file)  # noqa: PTH116 - hundreds of files
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


#: In the robot project, and out of version control.
_FILE = Path(".pyfrc", "passes.json")
_FORMAT = 2


@dataclass
class _Kept:
    """The content of the file.

    :param basis: a hash of what every test depends on
    :param elsewhere: the versions of the files that were imported from outside the project
    :param tests: for each test that has passed, the hash of its file
    :param green: a hash of all that the last run of all tests read, if all passed
    :param green_at: when that was, in ISO 8601
    :param left_over: what a test of the last run has left, so that the next ones needed new interpreters
    """

    basis: str = ""
    elsewhere: dict[str, str] = field(default_factory=dict)
    tests: dict[str, str] = field(default_factory=dict)
    green: str = ""
    green_at: str = ""
    left_over: str = ""
    format: int = _FORMAT


class Passes:
    """The passes of one project, as they are when a run of its tests begins.

    :param seed: the random seed of the run
    :param builtin: whether the ready-made tests run if the project has none
    :param written: directories that the run writes
    """

    def __init__(
        self, project: Project, seed: int = DEFAULT_SEED, builtin: bool = False, written: Iterable[Path] = ()
    ) -> None:
        self._project = project
        self._written = list(written)
        self._file = project.root / _FILE
        self._begin = read_contents(project, self._written)
        rules = {project.files.relative(str(file)) for file in project.invariant_files}
        conditions = [seed, builtin, project.main_file.name, project.class_name]
        self._basis = _basis_of(self._begin, conditions, rules)
        self._version_elsewhere = cache(version_of_file)
        self._kept = replace(_load(self._file), left_over="")
        # Files from elsewhere are known only after a run has imported them.
        if self._kept.basis != self._basis or any(
            self._version_elsewhere(file) != known for file, known in self._kept.elsewhere.items()
        ):
            self._kept = _Kept(self._basis)

    # -- single tests ----------------------------------------------------------------------------------------------

    def is_valid(self, test: str, file: Path) -> bool:
        """Return whether a test in this file has passed, and no file that it depends on has changed since."""
        return self._kept.tests.get(test) == self._hash_of(file)

    def record(self, test: str, file: Path) -> None:
        """Keep that a test in this file has passed."""
        self._kept.tests[test] = self._hash_of(file)

    def forget(self, test: str) -> None:
        """Keep no pass of a test: it did not pass now."""
        self._kept.tests.pop(test, None)

    def _hash_of(self, file: Path) -> str:
        path = Path(self._project.files.relative(str(file))).as_posix()
        return self._begin.sources.get(path) or self._version_elsewhere(str(file))

    def set_left_over(self, reason: str) -> None:
        """Keep what a test has left, for which the next one needed a new interpreter."""
        self._kept.left_over = reason

    # -- the whole run ---------------------------------------------------------------------------------------------

    def set_green(self, passed: bool) -> None:
        """Keep whether all tests of the project have passed."""
        self._kept.green = self._green_hash() if passed else ""
        self._kept.green_at = datetime.now().astimezone().isoformat(timespec="seconds")

    def green_since(self) -> datetime | None:
        """Return when all tests of the project passed, if nothing that they read has changed since."""
        if self._kept.green != self._green_hash():
            return None
        return datetime.fromisoformat(self._kept.green_at)

    def _green_hash(self) -> str:
        return hash_of(json.dumps([self._basis, sorted(self._begin.sources.items())]).encode())

    def save(self, elsewhere: Iterable[str]) -> list[str]:
        """Write the passes to the project.

        :param elsewhere: the files that the run has imported from outside the project
        :return: files that have changed during the run, for which nothing is kept
        """
        self._kept.elsewhere |= {file: self._version_elsewhere(file) for file in sorted(elsewhere)}
        changed = self._begin.differences(read_contents(self._project, self._written))
        if changed:
            self._kept = _Kept(left_over=self._kept.left_over)
        with suppress(OSError):  # the next run runs everything
            write_whole(self._file, [json.dumps(vars(self._kept))])
            keep_out_of_version_control(self._file.parent)
        return changed


def left_over(project: Project) -> str:
    """Return what a test of the last run had left, for which the next ones needed new interpreters."""
    return str(_load(project.root / _FILE).left_over)


def _basis_of(contents: Contents, conditions: list[object], rules: set[str]) -> str:
    """Return a hash of what every test depends on: packages, conditions, and all files that are no tests.

    :param rules: files with a team's rules, which concern all tests, also where they are tests
    """
    sources = [
        (path, content)
        for path, content in sorted(contents.sources.items())
        if path in rules or not any(map(PurePath(path).match, TEST_FILES))
    ]
    facts = [environment(), *conditions, sorted(rules), sources, sorted(contents.others.items())]
    return hash_of(json.dumps(facts).encode())


def _load(file: Path) -> _Kept:
    with suppress(OSError, ValueError, TypeError, AttributeError):
        kept = _Kept(**json.loads(file.read_text("utf-8")))
        if kept.format == _FORMAT and isinstance(kept.tests, dict) and isinstance(kept.elsewhere, dict):
            return kept
    return _Kept()  # it does not exist, or is not ours
