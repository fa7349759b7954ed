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
from itertools import chain, islice
from pathlib import Path, PurePath

from .._version import __version__
from ..config.settings import DEFAULT_SEED
from ..file_hash import hash_file
from ..project import TEST_FILES, Project
from ..project.git import git_output
from ..project.loaded_modules import PACKAGES, loaded_modules
from ..project.walk import LEFT_OUT, SourceError, files_below, read_source
from ..text_files import keep_out_of_version_control, write_whole
from ..wording import path_from

#: Where pytest looks for settings and fixtures in the directories above the project.
_READ_ABOVE = (
    *("conftest.py", "pytest.ini", ".pytest.ini", "pytest.toml", ".pytest.toml"),
    *("pyproject.toml", "tox.ini", "setup.cfg"),
)
#: The variables with which a user changes how Python and pytest run, and their values where they are not set.
_VARIABLES = dict.fromkeys(("PYTEST_ADDOPTS", "PYTEST_PLUGINS", "PYTEST_DISABLE_PLUGIN_AUTOLOAD"), "")
_VARIABLES |= dict.fromkeys(("PYTHONPATH", "PYTHONOPTIMIZE", "PYTHONWARNINGS", "TZ"), "")
_VARIABLES["PYTHONHASHSEED"] = "0"  # so `pyfrc test` sets it
#: In a project with more files than this, as when a home directory is one, no passes are kept.
MOST_FILES = 10_000
#: Of a larger file, in bytes, the size and the times count, and not the content.
_LARGE = 1 << 20
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


def read_contents(project: Project) -> Contents:
    """Return the project's current contents, with what pytest reads above it: of at most `MOST_FILES` and one more."""
    contents = Contents({}, {})
    above = (directory / name for directory in project.root.parents for name in _READ_ABOVE)
    for file in islice(chain(filter(Path.is_file, above), project_files(project)), MOST_FILES + 1):
        kind = contents.sources if file.suffix == ".py" else contents.others
        kind[Path(path_from(project.root, file)).as_posix()] = hash_of_file(file)
    return contents


def project_files(project: Project) -> Iterator[Path]:
    """Yield the files of a project: below it and beside it, except those that `project.walk` leaves out."""
    beside = project.test_directories[1]
    yield from files_below(project.root)
    if not beside.is_relative_to(project.root):
        yield from files_below(beside)
    if project.pyproject.parent != project.root and project.pyproject.is_file():
        yield project.pyproject
    # What a team has put under version control is no tool's own, but for compiled files, which many commit unawares.
    for name in (git_output(project.root, "ls-files", "-z", seconds=5) or "").split("\0"):
        if LEFT_OUT.intersection(PurePath(name).parts) and not name.endswith(".pyc"):
            yield project.root / name


def hash_of_file(file: Path) -> str:
    """Return a hash of the file's content; of a file that cannot be read, one that no content has."""
    try:
        status = file.stat()
        if status.st_size > _LARGE:
            return f"{status.st_size} {status.st_mtime_ns} {status.st_ctime_ns}"
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
    """Return a hash of Python, its settings in the environment, pyfrc's version and the installed packages.

    A package that is installed again counts as changed, also with the same version. The files of editable packages
    count as `loaded_from_elsewhere`.
    """
    facts = [sys.version, platform.machine(), platform.system(), __version__]
    facts += [os.environ.get(name, otherwise) for name, otherwise in _VARIABLES.items()]
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


def loaded_from_elsewhere(project: Project, with_pyfrc: bool = True) -> set[str]:
    """Return the source files that this process has imported from outside the project, Python and its packages."""
    is_ours = project.files.is_project_file
    files = {str(module.__file__) for module in loaded_modules.look() if module.__name__ != "__main__"}
    return {file for file in files if not is_ours(file)}.union(loaded_modules.files_of_pyfrc() if with_pyfrc else ())


#: In the robot project, and out of version control.
_FILE = Path(".pyfrc", "passes.json")
_FORMAT = 3


@dataclass
class _Kept:
    """The content of the file.

    :param basis: a hash of what every test depends on
    :param elsewhere: the versions of the files that were imported from outside the project
    :param tests: for each test that has passed, the hash of its file
    :param green: a hash of all that the last run of all tests read, if all passed
    :param green_at: when that was, in ISO 8601
    :param left_over: what a test of the last run has left, so that the next ones needed new interpreters
    :param written: the files that pyfrc has written in runs, such as robots' data logs, with the content that they got
    """

    basis: str = ""
    elsewhere: dict[str, str] = field(default_factory=dict)
    tests: dict[str, str] = field(default_factory=dict)
    green: str = ""
    green_at: str = ""
    left_over: str = ""
    written: dict[str, str] = field(default_factory=dict)
    format: int = _FORMAT


class Passes:
    """The passes of one project, as they are when a run of its tests begins.

    :param seed: the random seed of the run
    :param builtin: whether the ready-made tests run in any case
    """

    def __init__(self, project: Project, seed: int = DEFAULT_SEED, builtin: bool = False) -> None:
        self._project = project
        self._file = project.root / _FILE
        self._begin = read_contents(project)
        self._rules = {project.files.relative(str(file)) for file in project.invariant_files}
        self._conditions = [environment(), seed, builtin, project.main_file.name, project.class_name]
        self._is_whole = len(self._begin.sources) + len(self._begin.others) <= MOST_FILES
        kept = _load(self._file)
        #: The files that earlier runs have written, and that are still the same: no test needs them.
        self._written = {path for path, content in kept.written.items() if self._begin.others.get(path) == content}
        self._basis = self._basis_without(self._written)
        self._version_elsewhere = cache(version_of_file)
        self._kept = replace(kept, left_over="")
        # Files from elsewhere are known only after a run has imported them.
        if self._kept.basis != self._basis or any(
            self._version_elsewhere(file) != known for file, known in self._kept.elsewhere.items()
        ):
            self._kept = _Kept(self._basis)
        #: Whether all tests have passed with the present content.
        self._green = self._kept.green == self._green_hash()

    def _basis_without(self, written: Collection[str]) -> str:
        """Return a hash of what every test depends on: packages, conditions, and all files that are no tests.

        A test file that another file names counts, too: it may be imported there. So do a team's rules, wherever.

        :param written: files that do not count
        """
        every = self._begin.sources
        tests = [path for path in every if any(map(PurePath(path).match, TEST_FILES)) and path not in self._rules]
        shared = _named_elsewhere(self._project.root, tests, every)
        sources = [each for each in sorted(every.items()) if each[0] not in tests or each[0] in shared]
        others = [each for each in sorted(self._begin.others.items()) if each[0] not in written]
        return hash_of(json.dumps([*self._conditions, sorted(self._rules), sources, others]).encode())

    # -- single tests ----------------------------------------------------------------------------------------------

    def is_valid(self, test: str, file: Path) -> bool:
        """Return whether a test in this file has passed, and no file that it depends on has changed since."""
        return self._is_whole and self._kept.tests.get(test) == self._hash_of(file)

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
        self._green = passed
        self._kept.green_at = datetime.now().astimezone().isoformat(timespec="seconds")

    def green_since(self) -> datetime | None:
        """Return when all tests of the project passed, if nothing that they depend on has changed since."""
        return datetime.fromisoformat(self._kept.green_at) if self._green and self._is_whole else None

    def _green_hash(self) -> str:
        return hash_of(json.dumps([self._basis, sorted(self._begin.sources.items())]).encode())

    def save(self, elsewhere: Iterable[str], written: Iterable[str] = ()) -> str:
        """Write the passes to the project.

        A file that the run has written counts as changed only if it was there before, with other content than the last
        run has given it: a test may have read that.

        :param elsewhere: the files that the run has imported from outside the project
        :param written: the files that pyfrc has written in this run
        :return: why nothing is kept, such as a file that has changed during the run; or an empty text
        """
        self._kept.elsewhere |= {file: self._version_elsewhere(file) for file in sorted(elsewhere)}
        before, end = self._begin.others, read_contents(self._project)
        mine = {Path(path_from(self._project.root, file)).as_posix() for file in written} & end.others.keys()
        expected = {path for path in mine if path not in before or path in self._written}
        changed = [path for path in self._begin.differences(end) if path not in expected]
        same = {path for path in self._written if end.others.get(path) == before[path]}
        why_not = f"{changed[0]} changed during the run" if changed else ""
        if not self._is_whole:
            why_not = f"the project has more than {MOST_FILES} files"
        if why_not:
            self._kept = _Kept(left_over=self._kept.left_over)
        else:
            self._basis = self._kept.basis = self._basis_without(mine | same)
            self._kept.green = self._green_hash() if self._green else ""
        self._kept.written = {path: end.others[path] for path in mine | same}
        with suppress(OSError):  # the next run runs everything
            write_whole(self._file, [json.dumps(vars(self._kept))])
            keep_out_of_version_control(self._file.parent)
        return why_not


def left_over(project: Project) -> str:
    """Return what a test of the last run had left, for which the next ones needed new interpreters."""
    return str(_load(project.root / _FILE).left_over)


def _named_elsewhere(root: Path, tests: Collection[str], sources: Iterable[str]) -> set[str]:
    """Return the test files whose names occur in another source, which may import or read them."""
    found = set()
    for path in sources if tests else ():
        with suppress(SourceError):
            text = read_source(root / path)
            found |= {test for test in tests if test != path and PurePath(test).stem in text}
    return found


def _load(file: Path) -> _Kept:
    with suppress(OSError, ValueError, TypeError, AttributeError):
        kept = _Kept(**json.loads(file.read_text("utf-8")))
        if kept.format == _FORMAT and isinstance(kept.tests, dict) and isinstance(kept.elsewhere, dict):
            return kept
    return _Kept()  # it does not exist, or is not ours
