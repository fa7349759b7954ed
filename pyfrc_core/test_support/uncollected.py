"""Find test files that pytest does not read, and those in which it finds no test."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fnmatch import fnmatch
from pathlib import Path

from ..project.walk import SourceError, python_files, read_source

_TESTS = re.compile(r"^(?:\s+|async )*def test|^class Test|^from pyfrc\.tests import", re.MULTILINE)
_READY_MADE_OFF = re.compile(r"^\s*#\s*from pyfrc\.tests import", re.MULTILINE)
_FUNCTION = re.compile(r"^def (\w*test\w*)\((?!.*fixture)", re.MULTILINE | re.IGNORECASE)
_NOT_TESTS = ("conftest.py", "__init__.py")


def find_uncollected(directory: Path, collected: set[Path], patterns: Sequence[str]) -> Iterator[str]:
    """Yield a sentence for each file in a directory of tests of which no test was collected.

    :param collected: the files of the tests that were collected
    :param patterns: pytest's patterns for the names of files with tests
    """
    for file in python_files(directory):
        if file in collected or file.name in _NOT_TESTS:
            continue
        try:
            text = read_source(file)
        except SourceError:  # reported as such
            continue
        name = file.relative_to(directory.parent).as_posix()
        if any(fnmatch(file.name, pattern) for pattern in patterns):
            yield f"{name}: no test was found in it. {_how_to_name(text)}"
        elif _TESTS.search(text):
            stem = re.sub(r"_?tests?_?", "_", file.stem).strip("_")
            better = f"test_{stem}.py" if stem else "test_robot.py"
            names = " and ".join(patterns)
            yield f"{name}: its tests are not run, since pytest reads files called {names}. Rename it to {better}."


def _how_to_name(text: str) -> str:
    if (off := _READY_MADE_OFF.search(text)) is not None:
        line = text.count("\n", 0, off.start()) + 1 + off[0].count("\n")
        return f"Remove the # in line {line}, for the ready-made tests."
    if (alike := _FUNCTION.search(text)) is not None:
        return f"The name of a test begins with test_: rename {alike[1]}."
    return "The name of a test begins with test_, as in: def test_drive(control, robot):"
