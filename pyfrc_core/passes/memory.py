"""Passed tests, kept in the project with what each of them ran and read."""

from __future__ import annotations

import json
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime
from functools import cache
from pathlib import Path, PurePath
from typing import Any

from ..config.settings import DEFAULT_SEED
from ..project import TEST_FILES, Project
from ..text_files import keep_out_of_version_control, write_whole
from .blocks import MODULE, blocks_of
from .contents import Contents, environment, hash_of, read_contents, version_of_file
from .ran_functions import Place

#: In the robot project, and out of version control.
_FILE = Path(".pyfrc", "passes.json")
_FORMAT = 1

#: What a test has read: a source file of the project, a block of it, and the block's hash; or a file from elsewhere and
#: its version.
_Read = tuple[str, str, str]
#: In place of a block: the whole file, which is not the project's.
_ELSEWHERE = "*"


@dataclass
class _Kept:
    """The content of the file.

    :param basis: a hash of what every test depends on
    :param green: what the last run of all tests read, if all passed
    :param tests: what each test that has passed read
    """

    basis: str = ""
    green: dict[str, Any] | None = None
    tests: dict[str, frozenset[_Read]] = field(default_factory=dict)


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
        rules = [project.files.relative(str(file)) for file in project.invariant_files]
        self._basis = _basis_of(self._begin, [seed, builtin, project.main_file.name, project.class_name, rules])
        self._kept = _load(self._file)
        self._blocks = cache(lambda path: blocks_of((project.root / path).read_bytes()))
        self._version_elsewhere = cache(lambda file: version_of_file(Path(file)))

    # -- single tests ----------------------------------------------------------------------------------------------

    def is_valid(self, test: str) -> bool:
        """Return whether a test has passed, and nothing that it ran or read has changed since."""
        if self._kept.basis != self._basis or (reads := self._kept.tests.get(test)) is None:
            return False
        return all(self._now(file, block) == known for file, block, known in reads)

    def _now(self, file: str, block: str) -> str | None:
        """Return the hash of a block, or the version of a file, now; None if there is no such block."""
        if block == _ELSEWHERE:
            return self._version_elsewhere(file)
        return self._blocks(file).hashes.get(block) if file in self._begin.sources else None

    def record(self, test: str, places: Iterable[Place], modules: Iterable[str], elsewhere: Iterable[str]) -> None:
        """Keep that a test has passed.

        :param places: the functions that ran
        :param modules: the project's source files that were imported
        :param elsewhere: the files that were imported from outside the project
        """
        blocks = {(path, MODULE) for path in map(self._relative, modules)}
        for file, line in places:
            path = self._relative(file)
            blocks.add((path, MODULE))
            if path in self._begin.sources and (name := self._blocks(path).lines.get(line)) is not None:
                blocks.add((path, name))
        blocks |= {(file, _ELSEWHERE) for file in elsewhere}
        if self._kept.basis != self._basis:
            self._kept = _Kept(self._basis, self._kept.green)
        # A file that is not there now was made by the test, which makes it again.
        reads = ((file, block, self._now(file, block)) for file, block in blocks)
        self._kept.tests[test] = frozenset((file, block, known) for file, block, known in reads if known is not None)

    def forget(self, test: str) -> None:
        """Keep no pass of a test: it did not pass now."""
        self._kept.tests.pop(test, None)

    def _relative(self, file: str) -> str:
        return Path(self._project.files.relative(file)).as_posix()

    # -- the whole run ---------------------------------------------------------------------------------------------

    def set_green(self, elsewhere: Iterable[str] | None) -> None:
        """Keep that all tests of the project have passed; None: that they have not."""
        self._kept.green = None
        if elsewhere is not None:
            self._kept.green = {
                "at": datetime.now().astimezone().isoformat(timespec="seconds"),
                "hash": self._green_hash(),
                "elsewhere": {file: self._version_elsewhere(file) for file in sorted(elsewhere)},
            }

    def green_since(self) -> datetime | None:
        """Return when all tests of the project passed, if nothing that they read has changed since."""
        green = self._kept.green
        if green is None or green["hash"] != self._green_hash():
            return None
        if any(self._version_elsewhere(file) != known for file, known in green["elsewhere"].items()):
            return None
        return datetime.fromisoformat(green["at"])

    def _green_hash(self) -> str:
        return hash_of(json.dumps([self._basis, sorted(self._begin.sources.items())]).encode())

    def save(self) -> list[str]:
        """Write the passes to the project.

        :return: files that have changed during the run, for which nothing is kept
        """
        changed = self._begin.differences(read_contents(self._project, self._written))
        if changed:
            self._kept = _Kept()
        with suppress(OSError):  # the next run runs everything
            write_whole(self._file, [json.dumps(_as_json(self._kept))])
            keep_out_of_version_control(self._file.parent)
        return changed


def _basis_of(contents: Contents, conditions: list[object]) -> str:
    """Return a hash of what every test depends on: packages, conditions, other files, and which sources exist.

    A new file with tests changes no other test, since nothing imports it. A file with rules concerns all tests.
    """
    names = [path for path in contents.sources if not any(map(PurePath(path).match, TEST_FILES))]
    facts = [environment(), *conditions, sorted(names), sorted(contents.others.items())]
    return hash_of(json.dumps(facts).encode())


def _load(file: Path) -> _Kept:
    try:
        content = json.loads(file.read_text("utf-8"))
        if content["format"] != _FORMAT:
            return _Kept()
        table: list[_Read] = [(path, block, known) for path, block, known in content["reads"]]
        tests = {name: frozenset(table[number] for number in numbers) for name, numbers in content["tests"].items()}
        return _Kept(content["basis"], content["green"], tests)
    except (OSError, ValueError, LookupError, TypeError, AttributeError):  # it does not exist, or is not ours
        return _Kept()


def _as_json(kept: _Kept) -> dict[str, Any]:
    """Return the content of the file. Most tests read the same, so what they read is numbered."""
    numbers = {read: number for number, read in enumerate(sorted(set().union(*kept.tests.values())))}
    tests = {name: sorted(numbers[read] for read in reads) for name, reads in kept.tests.items()}
    return {"format": _FORMAT, "basis": kept.basis, "green": kept.green, "reads": list(numbers), "tests": tests}
