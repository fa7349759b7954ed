"""The end of this process without unwinding its stack, and what has to happen before it."""

from __future__ import annotations

import atexit
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

#: The exit code of a process whose robot code could not be stopped otherwise.
EXIT_HANGS = 86

#: Called before robot code, or a signal, ends this process in the middle of its work; by name. Not in what robot code
#: forks: the files that are completed here are not its own.
before_sudden_exit: dict[str, Callable[[], object]] = {}
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=before_sudden_exit.clear)

#: Called by each `exit_now`, in this order: measurements are saved here.
before_every_exit: list[Callable[[], object]] = []

_exit = os._exit


def exit_now(status: int) -> NoReturn:
    """End this process at once, even where robot code's `os._exit` is replaced.

    :param status: the exit code
    """
    try:
        for call in before_every_exit:
            call()
    finally:
        _exit(status)


def exit_by_signal(number: int, frame: object, prepare: Callable[[], object] = lambda: None) -> NoReturn:
    """Handle a signal by ending this process, whatever it does. `Fork.terminate` sends it again: that is ignored.

    :param prepare: called before
    """
    signal.signal(number, signal.SIG_IGN)
    prepare()
    exit_now(128 + number)


def end_without_destruction() -> Callable[[int], object]:
    """Return a function that sets the exit code with which this process ends, after `atexit`'s calls.

    To be called first, as the last call of `atexit` is the one that was registered first. Without it, Python and C++
    would then destroy objects, in any order, while threads use them, such as those of NetworkTables' listeners, and
    libraries would end the process by SIGABRT.
    """
    here = os.getpid()
    status: list[int] = []

    def end() -> None:
        if status and os.getpid() == here:
            flush_output()
            exit_now(status[0])

    atexit.register(end)
    return status.append


@contextmanager
def in_this_process() -> Iterator[None]:
    """End a process that robot code forks in this context where it would leave it: the rest is its parent's work.

    It ends as Python does: with the status of `SystemExit`, or with the traceback of another exception.
    """
    __tracebackhide__ = True
    here, error = os.getpid(), None
    try:
        yield
    except BaseException as raised:
        error = raised
        raise
    finally:
        if os.getpid() != here:
            _end_forked(error)


def _end_forked(error: BaseException | None) -> NoReturn:
    import traceback

    from ..project.robot_files import past_pyfrc

    status = 1
    if isinstance(error, SystemExit) and not isinstance(error.code, str):
        status = error.code or 0
    elif error is not None:
        traceback.print_exception(error.with_traceback(past_pyfrc(error.__traceback__)))
    else:
        print(
            "error: a process that robot code has forked goes on as the robot; end it with os._exit()", file=sys.stderr
        )
    flush_output()
    exit_now(status)


def prepare_sudden_exit() -> None:
    """Call each of `before_sudden_exit`, whatever the others raise, and end the child processes of robot code."""
    for call in list(before_sudden_exit.values()):
        with suppress(Exception):
            call()
    end_child_processes()


def flush_output() -> None:
    """Write out what was printed, as far as that is possible."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):  # its reader has gone, or it is closed
            stream.flush()


def end_child_processes() -> None:
    """Kill the processes that robot code has started here with `multiprocessing`."""
    for process in _child_processes():
        if process not in _of_another:
            process.kill()


def disown_child_processes() -> None:
    """In a fork of a process: leave those to it that it has started."""
    _of_another.extend(_child_processes())


_of_another: list[BaseProcess] = []


def _child_processes() -> list[BaseProcess]:
    multiprocessing = sys.modules.get("multiprocessing")
    return multiprocessing.active_children() if multiprocessing is not None else []
