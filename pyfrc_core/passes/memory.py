"""Passed tests, kept in the project with the files that they depend on."""

from __future__ import annotations

import json
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from datetime import datetime
from functools import cache
from pathlib import Path, PurePath

from ..config.settings import DEFAULT_SEED
from ..project import TEST_FILES, Project
from ..text_files import keep_out_of_version_control, write_whole
from .contents import Contents, environment, hash_of, read_contents, version_of_file

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
    """

    basis: str = ""
    elsewhere: dict[str, str] = field(default_factory=dict)
    tests: dict[str, str] = field(default_factory=dict)
    green: str = ""
    green_at: str = ""
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
        self._version_elsewhere = cache(lambda file: version_of_file(Path(file)))
        self._kept = _load(self._file)
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
            self._kept = _Kept()
        with suppress(OSError):  # the next run runs everything
            write_whole(self._file, [json.dumps(asdict(self._kept))])
            keep_out_of_version_control(self._file.parent)
        return changed


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
