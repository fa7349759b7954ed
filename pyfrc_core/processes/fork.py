"""Forks of this process: the work each does, and the bytes that it sends."""

from __future__ import annotations

import contextlib
import gc
import os
import selectors
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence

from ..errors import UsageError
from .crash_report import write_all
from .exit import disown_child_processes, exit_now, flush_output
from .owner import end_with, prepare_end_with

#: macOS has fork, but its system libraries do not survive it; Windows has none.
FORK_IS_SAFE = hasattr(os, "fork") and sys.platform not in ("win32", "darwin")


def is_forked(isolation: str) -> bool:
    """Return whether robot code runs in forks of this process.

    :param isolation: where the user wants it to run, outside this process
    :raises UsageError: when that is in forks, and they are not safe
    """
    if isolation == "fork" and not FORK_IS_SAFE:
        raise UsageError("this system cannot fork a process safely", remedy="Leave out --isolation fork.")
    return FORK_IS_SAFE and isolation != "reuse"


# Seconds between two looks at whether a process has ended while another one holds its pipe open. Decides nothing else.
_LOOK_SECONDS = 0.05
# The same for files of a new interpreter.
_FILES_LOOK_SECONDS = 0.005
# Robot code may replace the one in `time`.
_sleep = time.sleep
# A signal that comes just before Python begins to wait is handled after the wait, which only another signal ends.
_SIGNAL_AGAIN_SECONDS = 0.25


@contextlib.contextmanager
def forking_quietly() -> Iterator[None]:
    """Suppress Python's warning of forks where there are other threads; the ones here (numpy's) are made for it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        yield


class Fork:
    """A fork of this process.

    :param work: called there with a function that sends bytes to this process; must end the process
    """

    #: Seconds that `kill` leaves to a process between SIGTERM and SIGKILL; more than 0 while measurements are saved.
    grace_seconds = 0.0

    _pid: int
    _pipe: int

    def __init__(self, work: Callable[[Callable[[bytes], None]], object]) -> None:
        self.message = b""
        self.finished = False
        #: The exit code, when it has finished; a signal's number, negative.
        self.status = 0
        if sys.platform == "win32":
            raise NotImplementedError
        self._pipe, writing_end = os.pipe()
        os.set_blocking(self._pipe, False)
        flush_output()
        prepare_end_with()
        in_main_thread = threading.current_thread() is threading.main_thread()
        if in_main_thread and signal.getsignal(signal.SIGCHLD) is signal.SIG_IGN:
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)  # which does not say how a process has ended
        owner = os.getpid() if in_main_thread else None
        with forking_quietly():
            self._pid = os.fork()
        if self._pid == 0:
            try:
                # Garbage of the other process is not collected here: WPILib's objects would wait for ever for locks
                # that its threads held.
                gc.freeze()
                disown_child_processes()
                if owner is not None:  # another thread may end before its process
                    end_with(owner)
                work(lambda data: write_all(writing_end, data))
            finally:  # what is further out on the stack is for the process that was forked to unwind
                exit_now(1)
        os.close(writing_end)

    def fileno(self) -> int:
        """What becomes readable when there is something to `poll`."""
        return self._pipe

    def poll(self) -> None:
        """Take in what has come, and see whether the process has ended."""
        if self.finished:
            return
        # Asked before the pipe is read to its end: what an ended process wrote is there by now.
        ended = self._reap(wait=False)
        while True:
            try:
                data = os.read(self._pipe, 1 << 20)
            except BlockingIOError:
                break
            if not data:
                ended = ended or self._reap(wait=True)
                break
            self.message += data
        if ended:
            self.finished = True
            os.close(self._pipe)

    def send_signal(self, number: signal.Signals) -> None:
        """Send the process a signal, if it has not ended."""
        if not self.finished:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._pid, number)

    def kill(self) -> None:
        """End the process without waiting for its work."""
        self.terminate(self.grace_seconds)

    def terminate(self, seconds: float) -> None:
        """End the process by SIGTERM; when it has not ended after some wall seconds, by SIGKILL."""
        if seconds and not self.finished:
            send_again = now = time.monotonic()
            deadline = now + seconds
            while not self.finished and now < deadline:
                if now >= send_again:
                    self.send_signal(signal.SIGTERM)
                    send_again = now + _SIGNAL_AGAIN_SECONDS
                # The pipe, if nothing else holds it open, is closed when the process ends.
                wait_for_any([self._pipe])
                self.poll()
                now = time.monotonic()
        if not self.finished and sys.platform != "win32":
            self.send_signal(signal.SIGKILL)
            self._reap(wait=True)
            self.finished = True
            os.close(self._pipe)

    def _reap(self, wait: bool) -> bool:
        if sys.platform == "win32":
            raise NotImplementedError
        try:
            pid, status = os.waitpid(self._pid, 0 if wait else os.WNOHANG)
        except ChildProcessError:  # code of this process has waited for it: how it has ended is not known
            return True
        if pid:
            self.status = os.waitstatus_to_exitcode(status)
        return bool(pid)


def wait_for_any(descriptors: Sequence[int]) -> None:
    """Return when one of these has something to read, or a short while has passed."""
    if not descriptors:  # of new interpreters, whose messages are in files; Windows refuses to select from nothing
        _sleep(_FILES_LOOK_SECONDS)
        return
    # `poll`, where there is one, needs no descriptor of its own.
    with getattr(selectors, "PollSelector", selectors.DefaultSelector)() as selector:
        for descriptor in descriptors:
            selector.register(descriptor, selectors.EVENT_READ)
        selector.select(_LOOK_SECONDS)
