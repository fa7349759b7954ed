"""Errors that the HAL reports: it writes them to standard error."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import IO

_ERROR = re.compile(rb"^Error at ([^\n]*)\n", re.MULTILINE)
#: What is no fault of the robot's code (joysticks that are not plugged in), is found in a better way (slow loops), or
#: comes from every robot that has nothing to tell its drive for a tenth of a second, and stands still.
_NO_FAULT = re.compile(rb"Joystick .*not (?:available|attached|plugged)|Loop time of|Output not updated", re.IGNORECASE)


class HalReports:
    """The reports of one run.

    :param file: where standard error goes meanwhile
    """

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self._read = 0

    def error(self) -> str | None:
        """The first error that was reported since this was last asked; only of lines that are whole."""
        descriptor = self._file.fileno()
        size = os.fstat(descriptor).st_size
        if size == self._read:
            return None
        new = os.pread(descriptor, size - self._read, self._read) if hasattr(os, "pread") else self._read_again(size)
        whole = new[: new.rfind(b"\n") + 1]
        self._read += len(whole)
        for found in _ERROR.finditer(whole):
            if not _NO_FAULT.search(found[1]):
                return found[1].decode(errors="replace").strip()
        return None

    def _read_again(self, size: int) -> bytes:
        """Where there is only one place to read and to write at, as on Windows."""
        descriptor = self._file.fileno()
        os.lseek(descriptor, self._read, os.SEEK_SET)
        new = os.read(descriptor, size - self._read)
        os.lseek(descriptor, 0, os.SEEK_END)
        return new


@contextmanager
def hal_reports() -> Iterator[HalReports]:
    """Listen while this lasts; what was reported is passed on to standard error at the end.

    Some of it comes from C, and some through Python's own standard error, which need not be the same (in pytest).
    """
    stderr = sys.stderr
    stderr.flush()
    with tempfile.TemporaryFile(buffering=0) as file:
        real = os.dup(2)
        os.dup2(file.fileno(), 2)
        sys.stderr = open(file.fileno(), "w", encoding="utf-8", errors="replace", buffering=1, closefd=False)  # noqa: SIM115
        try:
            yield HalReports(file)
        finally:
            sys.stderr.flush()
            sys.stderr = stderr
            os.dup2(real, 2)
            os.close(real)
            file.seek(0)
            stderr.write(file.read().decode(errors="replace"))
