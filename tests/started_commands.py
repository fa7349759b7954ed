"""Commands that go on beside a test, which reads what they print, and sends them signals."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from threading import Thread, Timer
from types import TracebackType
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from pyfrc_core.processes.spawn import StartedProcess


class StartedCommand:
    """A command that runs, with what tests use of `subprocess.Popen`; it is killed at the end of a ``with`` block.

    :ivar stdout: what it prints
    :ivar stderr: its errors; None where they are among what it prints
    :ivar read: what `until` and `rest` have read of it
    """

    def __init__(self, process: StartedProcess, stdout: IO[str], stderr: IO[str] | None) -> None:
        self._process = process
        self.stdout = stdout
        self.stderr = stderr
        self.read = ""

    def __enter__(self) -> StartedCommand:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.kill()
        self.wait()
        self._close()

    def _close(self) -> None:
        for stream in filter(None, (self.stdout, self.stderr)):
            stream.close()

    @property
    def pid(self) -> int:
        return self._process.pid

    def poll(self) -> int | None:
        return self._process.poll()

    def wait(self, seconds: float | None = None) -> int:
        """Wait for its end, and return the exit code; negative: the signal that ended it."""
        return self._process.wait(seconds)

    def kill(self) -> None:
        self._process.kill()

    def send_signal(self, number: int) -> None:
        if self.poll() is None:
            with suppress(ProcessLookupError):
                os.kill(self.pid, number)

    def until(self, pattern: str) -> str:
        """Read what it prints until a line has this regular expression, and return that line."""
        for line in self.stdout:
            self.read += line
            if re.search(pattern, line):
                return line
        raise AssertionError(f"{pattern!r} was not printed:\n{self.read}")

    def rest(self, seconds: float | None = None) -> tuple[str, str]:
        """Return all that it prints until its end: output and errors.

        :param seconds: after which it is killed
        """
        errors: list[str] = []
        with ExitStack() as at_end:
            if self.stderr is not None:
                # A daemon: pytest's end does not wait for it.
                reading = Thread(target=lambda stream: errors.append(stream.read()), args=[self.stderr], daemon=True)
                reading.start()
                at_end.callback(reading.join)
            if seconds is not None:
                guard = Timer(seconds, self.kill)
                guard.start()
                at_end.callback(guard.cancel)
            at_end.callback(self.wait)
            printed = self.stdout.read()
        self.read += printed
        self._close()
        return printed, "".join(errors)


def start_command(
    start: Callable[[Sequence[int]], StartedProcess], stdin: int | None = None, apart: bool = False
) -> StartedCommand:
    """Start a command, and read what it prints.

    :param start: starts it, with the descriptors of its standard input, output and errors
    :param stdin: a descriptor of its input; by default, it has none
    :param apart: whether its errors are not among what it prints
    """
    out, their_out = os.pipe()
    err, their_err = os.pipe() if apart else (None, their_out)
    with Path(os.devnull).open("rb") as nothing:
        process = start([nothing.fileno() if stdin is None else stdin, their_out, their_err])
    for descriptor in {their_out, their_err}:
        os.close(descriptor)
    errors = None if err is None else os.fdopen(err, encoding="utf-8", errors="replace")
    return StartedCommand(process, os.fdopen(out, encoding="utf-8", errors="replace"), errors)
