"""Errors that the HAL writes to standard error."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import IO

from ...processes.memory_file import memory_file
from ...wpi import reports

#: The stack with which the HAL writes an error (`runtime.patches.robot_stack`), and a call in it.
_STACK, _CALL = re.compile(rb"(?: .*\n)*"), re.compile(r'  File "([^"]+)", line (\d+), in (\S+)')


class HalReports:
    """The reports of one run.

    :param file: the empty file to which standard error is redirected
    """

    def __init__(self, file: IO[bytes]) -> None:
        self._descriptor = file.fileno()
        self._read = 0

    def error(self) -> tuple[str, str, int, str] | None:
        """Return the first error since the last call, from complete lines only; None if there was none.

        With it come file, line and function of the robot's code that led to it, which are empty if they are unknown.
        """
        begin = self._read
        descriptor = self._descriptor
        # All writers share the position of this file with standard error.
        size = os.lseek(descriptor, 0, os.SEEK_CUR)
        if size == begin:
            return None
        new = os.pread(descriptor, size - begin, begin) if hasattr(os, "pread") else self._read_again(size)
        whole = new[: new.rfind(b"\n") + 1]
        self._read += len(whole)
        for found in reports.ERROR.finditer(whole):
            if not reports.NO_FAULT.search(found[1]):
                calls = _CALL.findall(_STACK.match(whole, found.end())[0].decode(errors="replace"))  # type: ignore[index]
                file, line, function = calls[-1] if calls else ("", 0, "")
                return found[1].decode(errors="replace").strip(), file, int(line), function
        return None

    def _read_again(self, size: int) -> bytes:
        """Read from a file with a single position for reading and writing, as on Windows."""
        descriptor = self._descriptor
        os.lseek(descriptor, self._read, os.SEEK_SET)
        new = os.read(descriptor, size - self._read)
        os.lseek(descriptor, 0, os.SEEK_END)
        return new


@contextmanager
def hal_reports() -> Iterator[HalReports]:
    """Collect the reports until the context ends, then copy them to standard error.

    Some come from C, others through Python's own standard error; under pytest these are two streams.
    """
    stderr = sys.stderr
    stderr.flush()
    with memory_file() as file:
        real = os.dup(2)
        os.dup2(file.fileno(), 2)
        sys.stderr = captured = open(file.fileno(), "w", encoding="utf-8", errors="replace", buffering=1, closefd=False)  # noqa: SIM115
        try:
            yield HalReports(file)
        finally:
            with suppress(ValueError):  # robot code has closed it
                captured.flush()
            sys.stderr = stderr
            os.dup2(real, 2)
            os.close(real)
            written = file.tell()
            file.seek(0)
            stderr.write(file.read(written).decode(errors="replace"))
