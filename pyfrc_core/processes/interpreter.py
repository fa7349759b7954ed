"""A new interpreter, which does one piece of work after the other as long as it is as good as new.

What it is to do comes over its standard input, as frames. What it sends, its crash log, and that a piece of work is
done, are files in a directory of its own: they outlive the process that has written them, and are the same on every
system. The owner looks at them; nothing waits in a thread.

After each piece of work, the interpreter puts itself back into the state in which it was before the first one, and
writes what it could not put back. If that is anything, it ends. Without an `InitialState`, it ends after its first
work.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from functools import partial
from itertools import count
from pathlib import Path
from typing import IO, NoReturn, Protocol

from ..collector import collector_paused
from ..temporary import temporary_directory
from ..text_files import write_whole
from . import spawn
from .crash_report import CrashLog
from .exit import exit_now
from .fork import Fork, wait_for_any
from .frames import encode, read_frame
from .worker import Work, Worker, do_work, sender

#: Wall seconds in which an interpreter has to be as good as new. One that takes longer is not used again.
_PATIENCE = 10.0

_now = time.monotonic  # before robot time replaces it


class InitialState(Protocol):
    """The state of an interpreter before its first work."""

    def restore(self) -> Sequence[str]:
        """Put this process back into that state; return what is left that could not be put back."""


#: Called in a new interpreter before its first work; can be pickled.
Prepare = Callable[[], InitialState]


class Interpreter:
    """A new interpreter.

    :param prepare: None: it does one piece of work
    :param keeps_output: whether what it prints is in files, and not where these say:
    :param stdout, stderr, environment, ends_with_owner: see `spawn.Start`
    """

    def __init__(
        self,
        prepare: Prepare | None = None,
        *,
        keeps_output: bool = False,
        stdout: int | IO[bytes] | None = subprocess.DEVNULL,
        stderr: int | IO[bytes] | None = subprocess.DEVNULL,
        environment: Mapping[str, str] | None = None,
        ends_with_owner: bool = True,
    ) -> None:
        self._temporary = temporary_directory("process")
        self._directory = Path(self._temporary.name)
        self._ends_after_one = prepare is None
        self._number = 0
        with ExitStack() as files:
            if keeps_output:
                stdout, stderr = (files.enter_context(file.open("ab")) for file in _output_in(self._directory))
            call = partial(_serve, prepare, self._directory)
            how = spawn.Start(call, stdout, stderr, environment, ends_with_owner=ends_with_owner)
            self._process = spawn.open_interpreter(how)

    def begin(self, work: Work, owned: bool = False) -> SpawnedWorker:
        """Begin a piece of work; the one before must be over.

        :param owned: whether the interpreter ends with the worker
        """
        self._number += 1
        worker = SpawnedWorker(self, WorkFiles(self._directory, self._number), owned)
        with suppress(OSError):  # it has ended, which `poll` notices
            self._send(work)
        return worker

    def _send(self, work: Work) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(encode(work))
        self._process.stdin.flush()
        if self._ends_after_one:
            self._process.stdin.close()

    def poll(self) -> int | None:
        """Return the exit code; None while it has not ended."""
        return self._process.poll()

    @property
    def is_restored(self) -> bool:
        """Whether `left_over` is known."""
        return WorkFiles(self._directory, self._number).left.is_file()

    def left_over(self) -> Sequence[str] | None:
        """Return what its last work has left, when that is known; None if it has ended, and there is no more to it."""
        files, deadline = WorkFiles(self._directory, self._number), _now() + _PATIENCE
        while not files.left.is_file():
            if self._process.poll() is not None and not files.left.is_file():
                return None
            if _now() > deadline:
                self.kill()
                return [f"what takes longer than {_PATIENCE:g} s to put back"]
            wait_for_any([])
        return files.left.read_text("utf-8").splitlines()

    def printed(self) -> list[bytes]:
        """Return what it has printed until now, to stdout and to stderr; nothing where that is not kept."""
        return [_contents(file) for file in _output_in(self._directory)]

    def kill(self) -> int:
        """End it, whatever it does; return the exit code."""
        self._process.kill()
        return self._process.wait()

    def close(self) -> None:
        """End it, and remove what it has left."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()
        if Fork.grace_seconds:  # it saves measurements
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(Fork.grace_seconds)
        self.kill()
        self._temporary.cleanup()


class WorkFiles:
    """The files of one piece of work.

    :param number: its number, from 1
    """

    def __init__(self, directory: Path, number: int) -> None:
        self.messages = directory / f"{number}-messages"
        self.crash_log = directory / f"{number}-crash"
        #: The exit code, when the work is done and the process goes on.
        self.done = directory / f"{number}-done"
        #: What is left, a line for each, when the process is restored as far as it can be.
        self.left = directory / f"{number}-left"

    def remove(self) -> None:
        """Remove what has been read."""
        for file in (self.messages, self.crash_log, self.done):
            with suppress(OSError):  # Windows keeps what is open, and all is removed with the directory
                file.unlink()


class SpawnedWorker(Worker):
    """A piece of work that an interpreter does.

    :param owns: whether the interpreter is ended when this is closed
    """

    def __init__(self, interpreter: Interpreter, files: WorkFiles, owns: bool) -> None:
        super().__init__()
        self.interpreter = interpreter
        #: Whether the work is done, and the interpreter puts itself back.
        self.goes_on = False
        self._files, self._owns = files, owns
        self._printed_before = list(map(len, interpreter.printed()))
        self._printed: str | None = None

    def poll(self) -> None:
        if self.finished:
            return
        status = self.interpreter.poll()  # before the files are read: what an ended process wrote is there by now
        if self._files.done.is_file():
            self.goes_on = True
            self._end(int(_contents(self._files.done)))
        elif status is not None:
            self._end(status)

    def wait(self, look: Callable[[], object] = lambda: None) -> None:
        """Wait until it has finished; when that is interrupted, end its process.

        :param look: called from time to time
        """
        try:
            while not self.finished:
                wait_for_any([])
                self.poll()
                look()
        except BaseException:
            self.kill()
            raise

    def kill(self) -> None:
        if not self.finished:
            status = self.interpreter.kill()
            self.poll()
            if not self.finished:
                self._end(status)

    def close(self) -> None:
        self.kill()
        if self._owns:
            self.interpreter.close()
        else:
            self._files.remove()

    def printed(self) -> str:
        """Return what was printed to the files of the interpreter during this work."""
        if self._printed is not None:
            return self._printed
        texts = zip(self.interpreter.printed(), self._printed_before, strict=True)
        return "".join(text[before:].decode(errors="replace") for text, before in texts)

    def _end(self, status: int) -> None:
        self.status = status
        self._received = _contents(self._files.messages)
        self._printed = self.printed()  # the interpreter may do other work before this is asked for
        self.finished = True

    def _crash_report(self) -> bytes:
        return _contents(self._files.crash_log)


def spawn_worker(
    work: Work,
    stdout: int | IO[bytes] | None = subprocess.DEVNULL,
    stderr: int | IO[bytes] | None = subprocess.DEVNULL,
) -> SpawnedWorker:
    """Do a piece of work in an interpreter of its own.

    :param stdout, stderr: see `spawn.Start`
    """
    return Interpreter(stdout=stdout, stderr=stderr).begin(work, owned=True)


def _output_in(directory: Path) -> list[Path]:
    return [directory / "stdout", directory / "stderr"]


def _contents(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:
        return b""


# -- on the other side -----------------------------------------------------------------------------------------------


def _serve(prepare: Prepare | None, directory: Path) -> NoReturn:
    """Do one piece of work after the other."""
    requests = _take_requests()
    state: InitialState | None = None
    with suppress(EOFError), ExitStack() as kept:
        for number in count(1):
            files = WorkFiles(directory, number)
            messages, crash_log = (file.open("w+b", buffering=0) for file in (files.messages, files.crash_log))
            log = CrashLog(crash_log.fileno())
            log.enable()
            kept.close()  # until now, a fault would have been written into the log before
            kept.callback(crash_log.close)
            if prepare is not None and state is None:
                with collector_paused():
                    state = do_work(prepare, log)
                if state is None:
                    exit_now(1)
            work: Work = read_frame(requests)
            status = do_work(partial(_exit_code, work, messages, log), log)
            messages.close()
            if state is None or status is None:
                exit_now(1 if status is None else status)
            write_whole(files.done, [str(status)])
            left = state.restore()
            write_whole(files.left, ["\n".join(left)])
            if left:
                break
    exit_now(0)


def _exit_code(work: Work, messages: IO[bytes], log: CrashLog) -> int:
    return work(sender(messages.write), log) or 0


def _take_requests() -> IO[bytes]:
    """Return standard input as what only this module reads."""
    requests = os.fdopen(os.dup(0), "rb")
    nowhere = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nowhere, 0)
    os.close(nowhere)
    sys.stdin = Path(os.devnull).open(encoding="utf-8")  # noqa: SIM115 - until this process ends
    return requests
