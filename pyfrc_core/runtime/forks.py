"""Forks of this process, which has imported everything: the work each does, and the bytes it sends."""

from __future__ import annotations

import contextlib
import os
import selectors
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence

from ..hal import devices_exist, existing_devices
from .own_process import exit_now, write_all

#: macOS has fork, but its system libraries do not survive it; Windows has none.
FORK_IS_SAFE = hasattr(os, "fork") and sys.platform not in ("win32", "darwin")

# How long to wait before looking whether a process is gone without a word. Decides nothing else.
_LOOK_SECONDS = 0.05
_NAMED_DEVICES = 3


@contextlib.contextmanager
def forking_quietly() -> Iterator[None]:
    """Python warns of forking where other threads are; the ones here (numpy's) are made for it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        yield


def reasons_not_to_fork() -> list[str]:
    """Return what the project's code has made in this process and a fork of it would lack: threads and devices."""
    from .cooperative import threads_of_the_project  # with which comes WPILib

    reasons = [f"{line} starts {_described(thread)}" for thread, line in threads_of_the_project()]
    if devices_exist():
        devices = existing_devices()
        more = f" and {len(devices) - _NAMED_DEVICES} more" if len(devices) > _NAMED_DEVICES else ""
        reasons.append(f"devices are made: {', '.join(devices[:_NAMED_DEVICES])}{more}")
    return reasons


def _described(thread: threading.Thread) -> str:
    target = getattr(thread, "_target", None) or type(thread)
    name = getattr(target, "__qualname__", type(thread).__qualname__)
    module = getattr(target, "__module__", None)
    return f"the thread {thread.name!r}, which runs {module}.{name}" if module else f"the thread {thread.name!r}"


class Fork:
    """A fork of this process.

    :param work: what it does; it is given a function that sends bytes to this process, and must not return
    """

    def __init__(self, work: Callable[[Callable[[bytes], None]], object]) -> None:
        self.message = b""
        self.finished = False
        #: The exit code, when it has finished; a signal's number, negative.
        self.status = 0
        self._pipe, writing_end = os.pipe()
        os.set_blocking(self._pipe, False)
        sys.stdout.flush()
        sys.stderr.flush()
        with forking_quietly():
            self._pid = os.fork()
        if self._pid == 0:
            try:
                work(lambda data: write_all(writing_end, data))
            finally:  # what is further out on the stack is for the process that was forked to unwind
                exit_now(1)
        os.close(writing_end)

    def fileno(self) -> int:
        """What becomes readable when there is something to `poll`."""
        return self._pipe

    def poll(self) -> None:
        """Take in what has come, and see whether the process has ended."""
        # Asked before the pipe is read to its end: what an ended process wrote is there by now.
        ended = self._reap(os.WNOHANG)
        while True:
            try:
                data = os.read(self._pipe, 1 << 20)
            except BlockingIOError:
                break
            if not data:
                ended = ended or self._reap(0)
                break
            self.message += data
        if ended:
            self.finished = True
            os.close(self._pipe)

    def kill(self) -> None:
        """End the process without waiting for its work."""
        if not self.finished:
            os.kill(self._pid, signal.SIGKILL)
            self._reap(0)
            self.finished = True
            os.close(self._pipe)

    def terminate(self, seconds: float) -> None:
        """End the process by SIGTERM; when it has not ended after some wall seconds, `kill` it."""
        if not self.finished:
            os.kill(self._pid, signal.SIGTERM)
            deadline = time.monotonic() + seconds
            while not self.finished and time.monotonic() < deadline:
                # The pipe, if nothing else holds it open, is closed when the process ends.
                wait_for_any([self._pipe])
                self.poll()
        self.kill()

    def _reap(self, how: int) -> bool:
        pid, status = os.waitpid(self._pid, how)
        if pid:
            self.status = os.waitstatus_to_exitcode(status)
        return bool(pid)


def wait_for_any(descriptors: Sequence[int]) -> None:
    """Return when one of these has something to read, or a short while has passed."""
    with selectors.DefaultSelector() as selector:
        for descriptor in descriptors:
            selector.register(descriptor, selectors.EVENT_READ)
        selector.select(_LOOK_SECONDS)
