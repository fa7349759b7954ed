"""Processes that send objects to this one: the messages of each in their order, then its exit."""

from __future__ import annotations

import os
import sys
import time
import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import IO, Any, NoReturn, TypeVar

from ..project.robot_files import RobotFiles
from . import fork
from .crash_report import CrashLog, describe_exit, moment_of, standstill_of
from .exit import end_child_processes, exit_now, flush_output
from .frames import decode, encode
from .memory_file import memory_file
from .standstill import Standstill, loading_for

_now = time.monotonic  # which robot code may replace

#: Sends an object to the process that has started this one.
Send = Callable[[object], object]

Result = TypeVar("Result")

#: What a worker does, in its own process: it sends messages, and returns the exit code, or None for 0.
Work = Callable[[Send, CrashLog], int | None]


class Worker(ABC):
    """A process that works for this one.

    :ivar finished: whether it has ended, and all its messages are here
    :ivar status: its exit code when it has finished; a signal's number, negative
    """

    def __init__(self) -> None:
        self.finished = False
        self.status = 0
        self._received = b""
        self._begun = _now()

    @abstractmethod
    def poll(self) -> None:
        """Take in what has come, and see whether the process has ended."""

    @abstractmethod
    def kill(self) -> None:
        """End the process without waiting for its work."""

    @abstractmethod
    def close(self) -> None:
        """End the process, if it has not ended, and remove what it has left."""

    def fileno(self) -> int | None:
        """Return what becomes readable when there is something to `poll`, if there is such a descriptor."""
        return None

    def messages(self) -> Iterator[Any]:
        """Return what the process has sent until now, as far as it has come."""
        return decode(self._received)

    def describe_exit(self, files: RobotFiles, meanwhile: str) -> str:
        """Return why the process has ended too early: the user's line first, where it is known.

        :param meanwhile: when that was, such as "in the middle of the test"
        """
        return describe_exit(self._crash_report(), self.status, files, meanwhile)

    def standstill(self, files: RobotFiles) -> Standstill | None:
        """Return where its code makes no progress; None when it does. End a process in which no Python code can run."""
        standstill = standstill_of(self._crash_report(), files)
        if standstill is not None and standstill.hopeless:
            self.kill()
        return standstill

    def loading(self) -> Standstill | None:
        """Return the start of a process that takes seconds, until its robot's first moment; None when it does not."""
        return None if moment_of(self._crash_report()) is not None else loading_for(_now() - self._begun)

    @abstractmethod
    def _crash_report(self) -> bytes:
        """Return what is in its crash log."""


class ForkedWorker(Worker):
    """A fork of this process, where everything is imported already."""

    def __init__(self, work: Work) -> None:
        super().__init__()
        self._crash_log: IO[bytes] = memory_file()
        descriptor = self._crash_log.fileno()
        self._fork = fork.Fork(lambda send: work_and_exit(partial(work, sender(send)), descriptor))

    def fileno(self) -> int | None:
        return self._fork.fileno()

    def poll(self) -> None:
        self._fork.poll()
        self._take_over()

    def kill(self) -> None:
        self._fork.kill()
        self._take_over()

    def close(self) -> None:
        self.kill()
        self._crash_log.close()

    def loading(self) -> None:
        return None  # everything is there

    def _take_over(self) -> None:
        self.finished, self.status, self._received = self._fork.finished, self._fork.status, self._fork.message

    def _crash_report(self) -> bytes:
        if sys.platform == "win32":
            raise NotImplementedError
        # Its offset is that of the other process, too.
        return os.pread(descriptor := self._crash_log.fileno(), os.fstat(descriptor).st_size, 0)


def wait_for_any(workers: Sequence[Worker]) -> None:
    """Return when at least one of these has something new, or may have ended."""
    running = [worker for worker in workers if not worker.finished]
    numbers = [worker.fileno() for worker in running]
    fork.wait_for_any([number for number in numbers if number is not None])
    for worker in running:
        worker.poll()


# -- on the other side -----------------------------------------------------------------------------------------------


def work_and_exit(work: Callable[[CrashLog], int | None], crash_log: int) -> NoReturn:
    """Do the work in this process, which is its own, and end it.

    :param crash_log: the descriptor of an empty file, open for reading and writing
    """
    status = None
    try:
        log = CrashLog(crash_log)
        log.enable()
        status = do_work(lambda: work(log) or 0, log)
    finally:
        exit_now(1 if status is None else status)  # without waiting for what the work has left running


def do_work(work: Callable[[], Result], log: CrashLog) -> Result | None:
    """Return the result of work in this process; None if it has raised something, which is then in the log."""
    try:
        return work()
    except BaseException:
        log.write(traceback.format_exc())
        return None
    finally:
        end_child_processes()
        flush_output()


def sender(send: Callable[[bytes], object]) -> Send:
    """Return what sends objects, by a function that sends bytes."""
    return lambda content: send(encode(content))
