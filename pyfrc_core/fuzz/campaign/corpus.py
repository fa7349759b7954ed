"""The corpus of a project: scripts of failures in ``tests/fuzz``, and a test file that replays them.

Failures that did not repeat are in ``tests/fuzz/not_repeated``. The test does not replay them.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ...project import Project
from ...runtime.scripts.script import InputScript, load_script
from ...text_files import write_whole
from ..oracle.failure import FuzzFailure
from .describe import story_of

DIRECTORY = "fuzz"
NOT_REPEATED = "not_repeated"
TEST_FILE = "test_fuzz_regressions.py"

_TEST = '''\
"""Replay the failures that `pyfrc fuzz` has found: no script in the directory fuzz may make the robot fail again."""

from pathlib import Path

import pytest

SCRIPTS = sorted(Path(__file__).with_name("fuzz").glob("*.jsonl"))


@pytest.mark.parametrize("script", SCRIPTS, ids=[script.stem for script in SCRIPTS])
def test_it_is_repaired(script, control, robot):
    """Check that the robot does not fail with this script."""
    control.replay(script)
'''


@dataclass(frozen=True)
class CorpusEntry:
    """A script in the corpus."""

    file: Path
    script: InputScript

    @property
    def display_path(self) -> str:
        """Return the path relative to the current directory, if the file is below it; else the absolute path."""
        return os.path.relpath(self.file) if self.file.is_relative_to(Path.cwd()) else str(self.file)


class Corpus:
    """The scripts of failures among a project's tests."""

    def __init__(self, project: Project) -> None:
        self._project = project
        # Beside the existing tests; in a project without tests, beside the robot program.
        self._tests = project.find_tests() or project.test_directories[0]
        #: Why scripts are not written there, but elsewhere; empty if they are.
        self.problem = ""

    def all(self) -> Iterator[CorpusEntry]:
        """Return the scripts of earlier campaigns.

        :raises ScriptError: when a file is not a valid script
        """
        for file in sorted((self._tests / DIRECTORY).glob("*.jsonl")):
            yield CorpusEntry(file, load_script(file))

    def add(self, script: InputScript, failure: FuzzFailure) -> CorpusEntry:
        """Write a script to a file with a new name, and the test file if it does not exist.

        Of a failure that did not repeat, write it in place of an earlier one of the same failure. If the project cannot
        be written, write it to a temporary directory, which stays.
        """
        complete = _complete(script, failure)
        name = _name_of(failure)
        try:
            if complete.repeats:
                file = self._free_name(name)
                self._write_test()
            else:
                file = self._tests / DIRECTORY / NOT_REPEATED / f"{name}.jsonl"
            complete.save(file)
        except OSError as error:
            if not self.problem:
                self._tests = Path(tempfile.mkdtemp(prefix="pyfrc-found-"))
                self.problem = f"{error.filename}: {error.strerror}"
                return self.add(script, failure)
            raise
        return CorpusEntry(file, complete)

    def merge(self, directories: Iterable[Path]) -> list[CorpusEntry]:
        """Copy the scripts that shards of one campaign have found, as if one machine had found them; return the copies.

        Of several scripts of the same failure, the one of the earliest match is taken.

        :param directories: where the shards' scripts are, or a directory above; a script that is here already is left
            out
        :raises ScriptError: when a file is not a valid script
        """
        shards = [
            [CorpusEntry(file, load_script(file)) for file in sorted(each.rglob("*.jsonl"))] for each in directories
        ]
        own = {file.read_bytes() for file in (self._tests / DIRECTORY).rglob("*.jsonl")}
        # The scripts that all shards began with are here, too.
        contents = [{entry.file.read_bytes() for entry in shard} for shard in shards]
        old = own.intersection(*contents)
        found: dict[str, CorpusEntry] = {}
        for entry in sorted((entry for shard in shards for entry in shard if entry.script.found), key=_order):
            if entry.file.read_bytes() not in old:
                found.setdefault(str(entry.script.found.get("failure")), entry)
        return [self._copy(entry) for entry in found.values() if entry.file.read_bytes() not in own]

    def _copy(self, entry: CorpusEntry) -> CorpusEntry:
        name = _unnumbered(entry.file)[0]
        if entry.script.repeats:
            file = self._free_name(name)
            self._write_test()
        else:
            file = self._tests / DIRECTORY / NOT_REPEATED / entry.file.name
        write_whole(file, [entry.file.read_text("utf-8")])
        return CorpusEntry(file, entry.script)

    def _write_test(self) -> None:
        test_file = self._tests / TEST_FILE
        if not test_file.exists():
            write_whole(test_file, [_TEST])

    def _free_name(self, name: str) -> Path:
        directory = self._tests / DIRECTORY
        number, file = 1, directory / f"{name}.jsonl"
        while file.exists():
            number += 1
            file = directory / f"{name}-{number}.jsonl"
        return file


def found_in(seed: int, match: int | None, failure: FuzzFailure) -> dict[str, Any]:
    """Return the entry `found` of a script's header.

    :param match: the number of the match in the campaign with this seed; None for a match of an earlier campaign
    """
    number = {} if match is None else {"match": match}
    return {"seed": seed, **number, "failure": failure.cause}


def _order(entry: CorpusEntry) -> tuple[int, int, str, int]:
    """Return the key that sorts scripts as one campaign finds them."""
    found = entry.script.found
    return int(found.get("seed", 0)), int(found.get("match", -1)), *_unnumbered(entry.file)


def _unnumbered(file: Path) -> tuple[str, int]:
    """Return the name of a script's file without its number, and the number."""
    numbered = re.fullmatch(r"(.*?)-(\d+)", file.stem)
    return (numbered[1], int(numbered[2])) if numbered else (file.stem, 1)


def _complete(script: InputScript, failure: FuzzFailure) -> InputScript:
    packages = {name: version(name) for name in ("pyfrc", "wpilib")}
    return replace(script, packages=packages, story=script.story or story_of(script, failure))


def _name_of(failure: FuzzFailure) -> str:
    """Return a file name without a line number, since that changes with every line above it."""
    module = failure.place.partition(":")[0].removesuffix(".py")
    parts = [failure.kind, *re.split(r"[/\\]", module), failure.function]
    return re.sub(r"[^\w-]+", "_", "-".join(part for part in parts if part)).lower()
