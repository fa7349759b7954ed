"""Which lines of the core each test executes, in the processes that it starts, too.

`coverage` is not used, because it loses what a process has executed that is killed, and most processes of the core end
so. Here, each line that is executed sets one byte of a file that all processes have mapped to their memory.
"""

from __future__ import annotations

import mmap
import os
import pickle
import resource
import struct
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType
from typing import Any

#: At the beginning of the map: where the row of the current test begins.
_ROW = struct.Struct("<Q")

#: The row of what is executed by no test: imports.
_NO_TEST = 0


@dataclass
class LineTests:
    """What a run of all tests has shown.

    :param cpu_seconds: of each test, by its id, with the processes that it has started
    :param tests_by_line: the ids, by file and line; an import's is empty
    """

    cpu_seconds: dict[str, float] = field(default_factory=dict)
    tests_by_line: dict[str, dict[int, list[str]]] = field(default_factory=dict)

    def tests_of_file(self, file: str) -> set[str]:
        return {test for tests in self.tests_by_line.get(file, {}).values() for test in tests if test}

    def tests_of(self, file: str, lines: Iterable[int]) -> set[str]:
        """Return the tests that execute the first of these lines which is executed at all."""
        of_file = self.tests_by_line.get(file, {})
        return set(next((of_file[line] for line in lines if line in of_file), ()))


class LineRecorder:
    """Finds it out.

    :param directory: for its files; new interpreters find them there, because it is on their ``PYTHONPATH``
    :param files: whose lines are of interest: a path for each name
    """

    def __init__(self, directory: Path, files: Mapping[str, Path]) -> None:
        self._directory = directory
        self._files = files
        self._at: dict[str, int] = {}
        self._row_bytes = 0
        for name, path in files.items():
            self._at[name] = self._row_bytes
            self._row_bytes += path.read_bytes().count(b"\n") + 2
        self._result = LineTests()
        self._tests = [""]

    def begin(self, most_tests: int) -> None:
        """Begin to record, in this process and those that it starts."""
        self._directory.mkdir()
        with (self._directory / "map").open("wb") as file:
            file.truncate(_ROW.size + self._row_bytes * (most_tests + 1))
        offsets = {str(self._files[name]): at for name, at in self._at.items()}
        (self._directory / "offsets").write_bytes(pickle.dumps(offsets))
        (self._directory / "line_tests.py").write_bytes(Path(__file__).read_bytes())
        (self._directory / "sitecustomize.py").write_text("import line_tests\nline_tests.record_here()\n")
        os.environ["PYTHONPATH"] = os.pathsep.join([str(self._directory), os.environ.get("PYTHONPATH", "")])
        self._map = record_here(self._directory)
        self._set_row(_NO_TEST)

    @contextmanager
    def test(self, name: str) -> Iterator[None]:
        """While a test is run, what is executed belongs to it."""
        self._tests.append(name)
        self._set_row(len(self._tests) - 1)
        before = _cpu_seconds()
        try:
            yield
        finally:
            self._result.cpu_seconds[name] = _cpu_seconds() - before
            self._set_row(_NO_TEST)

    def result(self) -> LineTests:
        """Return what is known after the last test."""
        sys.settrace(None)
        for name, at in self._at.items():
            lines: dict[int, list[str]] = {}
            for number, test in enumerate(self._tests):
                start = _ROW.size + number * self._row_bytes + at
                row = self._map[start : start + self._files[name].read_bytes().count(b"\n") + 2]
                for line, byte in enumerate(row):
                    if byte:
                        lines.setdefault(line, []).append(test)
            self._result.tests_by_line[name] = lines
        return self._result

    def _set_row(self, number: int) -> None:
        _ROW.pack_into(self._map, 0, _ROW.size + number * self._row_bytes)


def record_here(directory: Path = Path(__file__).parent) -> mmap.mmap:
    """Record the lines of this process, all its threads and forks."""
    offsets: dict[str, int] = pickle.loads((directory / "offsets").read_bytes())
    with (directory / "map").open("r+b") as file:
        shared = mmap.mmap(file.fileno(), 0)

    def recorder(offset: int) -> Callable[[FrameType, str, Any], Any]:
        def record(frame: FrameType, event: str, arg: Any) -> Any:
            if event == "line":
                shared[_ROW.unpack_from(shared)[0] + offset + frame.f_lineno] = 1
            return record

        return record

    recorders = {file: recorder(offset) for file, offset in offsets.items()}

    def called(frame: FrameType, event: str, arg: Any) -> Any:
        return recorders.get(frame.f_code.co_filename)

    threading.settrace(called)
    sys.settrace(called)
    return shared


def _cpu_seconds() -> float:
    uses = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(use.ru_utime + use.ru_stime for use in uses)
