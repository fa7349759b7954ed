"""What a campaign keeps in the project: scripts in ``tests/fuzz``, and a test file that replays them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

from ..project import Project
from ..runtime.scripts.script import InputScript, load_script
from ..text_files import write_whole
from .describe import story_of
from .failure import FuzzFailure

DIRECTORY = "fuzz"
TEST_FILE = "test_fuzz_regressions.py"

_TEST = '''\
"""Replays what `pyfrc fuzz` has found: each script in the directory fuzz must no longer make the robot fail."""

from pathlib import Path

import pytest

SCRIPTS = sorted(Path(__file__).with_name("fuzz").glob("*.jsonl"))


@pytest.mark.parametrize("script", SCRIPTS, ids=[script.stem for script in SCRIPTS])
def test_it_is_repaired(script, control, robot):
    """The robot does not fail any more when it is told this."""
    control.replay(script)
'''


@dataclass(frozen=True)
class CorpusEntry:
    """A script that was kept."""

    file: Path
    script: InputScript

    @property
    def shown(self) -> str:
        """The file as one would type its name here."""
        return os.path.relpath(self.file) if self.file.is_relative_to(Path.cwd()) else str(self.file)


class Corpus:
    """The scripts in a project's tests."""

    def __init__(self, project: Project) -> None:
        self._project = project
        # Beside the tests there are; where there are none, beside the robot.
        self._tests = project.find_tests() or project.test_directories[0]

    def all(self) -> Iterator[CorpusEntry]:
        """Those that earlier campaigns have left.

        :raises ScriptError: when one is not what it must be
        """
        for file in sorted((self._tests / DIRECTORY).glob("*.jsonl")):
            yield CorpusEntry(file, load_script(file))

    def keep(self, script: InputScript, failure: FuzzFailure) -> CorpusEntry:
        """Write a script under a name of its own, and the test file if there is none."""
        kept = replace(
            script,
            packages={name: version(name) for name in ("pyfrc", "wpilib")},
            story=story_of(script, failure),
        )
        file = self._free_name(_name_of(failure))
        kept.save(file)
        test_file = self._tests / TEST_FILE
        if not test_file.exists():
            write_whole(test_file, [_TEST])
        return CorpusEntry(file, kept)

    def _free_name(self, name: str) -> Path:
        directory = self._tests / DIRECTORY
        number, file = 1, directory / f"{name}.jsonl"
        while file.exists():
            number += 1
            file = directory / f"{name}-{number}.jsonl"
        return file


def _name_of(failure: FuzzFailure) -> str:
    """Without a line's number, which changes with every line above it."""
    module = failure.place.partition(":")[0].removesuffix(".py")
    parts = [failure.kind, *re.split(r"[/\\]", module), failure.function]
    return re.sub(r"[^\w-]+", "_", "-".join(part for part in parts if part)).lower()
