"""The inputs of a running match, in a file, where they survive the end of its process."""

from __future__ import annotations

import marshal
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from ...runtime.scripts.script import Step


class Journal:
    """Writes the steps of a match to a file, which may have those of the parts before.

    :param file: is created if it does not exist
    """

    def __init__(self, file: Path) -> None:
        self._file = file.open("ab", buffering=0)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def add(self, step: Step) -> None:
        """Write a step, which is then safe."""
        # Only plain values are written, and in this version of Python they are read again.
        self._file.write(marshal.dumps((step.at_us, dict(step.writes))))


def read_journal(file: Path) -> Iterator[Step]:
    """Return the steps in a journal; none if there is no file."""
    if not file.is_file():
        return
    with file.open("rb") as steps, suppress(EOFError, ValueError, TypeError):  # the last step may be cut
        while True:
            at_us, writes = marshal.load(steps)
            yield Step(at_us, writes)
