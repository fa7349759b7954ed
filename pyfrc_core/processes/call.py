"""One function's call in another process: its result, its error, or how that process ended instead."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Generic, TypeVar

from ..errors import PyfrcError, RobotCodeError, text_of
from ..project import Project
from ..project.robot_files import RobotFiles
from .crash_report import CrashLog
from .exit import flush_output
from .fork import wait_for_any
from .interpreter import spawn_worker
from .reuse import Interpreters
from .standstill import StandstillNotice
from .worker import ForkedWorker, Send, Worker

Answer = TypeVar("Answer")


class _FailedThere(Exception):
    """The traceback of an error in the other process."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


def run_in_subprocess(
    work: Callable[[Project, CrashLog], Answer], project: Project, meanwhile: str, quietly: bool = True
) -> Answer:
    """Call a function in a new interpreter, and return what it returns.

    :param work: a function of a module, whose result can be pickled
    :param meanwhile: what robot code interrupts when it ends the process, such as "in the middle of the test"
    :param quietly: whether nothing that is printed there is shown
    :raises RobotCodeError: when the process ends without a result, naming the user's line
    :raises PyfrcError: as the function raises it, or `OSError`
    """
    # A copy, without what the project has read already.
    call = partial(_send_result, partial(work, replace(project)))
    output = subprocess.DEVNULL if quietly else None
    flush_output()
    worker = spawn_worker(call, stdout=output, stderr=output)
    notice = StandstillNotice()
    try:
        worker.wait(lambda: print_standstill(worker, notice, project.files))
        result: Answer = _result_of(worker, project.files, meanwhile)
        return result
    finally:
        worker.close()


class Call(Generic[Answer]):
    """A function that another process calls.

    :param worker: sends its result
    :param end: called when that is no longer needed
    :param files: of the project whose line is printed while its code makes no progress there
    """

    def __init__(self, worker: Worker, end: Callable[[], object], files: RobotFiles | None) -> None:
        self._files, self._notice = files, StandstillNotice(starts=False)  # of many in a row
        self._worker, self._end = worker, end

    @property
    def finished(self) -> bool:
        return self._worker.finished

    def fileno(self) -> int | None:
        """Return what becomes readable when there is something to `poll`, if there is such a descriptor."""
        return self._worker.fileno()

    def poll(self) -> None:
        """See whether it has finished; print where it makes no progress."""
        self._worker.poll()
        if self._files is not None:
            print_standstill(self._worker, self._notice, self._files)

    def wait(self) -> None:
        """Wait until it has finished."""
        while not self.finished:
            wait_for_calls([self])

    def close(self) -> None:
        """End the process, if it has not finished."""
        self._end()

    def result(self, files: RobotFiles, meanwhile: str) -> Answer:
        """Return what the function has returned.

        :param meanwhile: see `run_in_subprocess`, which raises the same
        """
        result: Answer = _result_of(self._worker, files, meanwhile)
        return result


class ForkedCall(Call[Answer]):
    """A function that a fork of this process calls.

    :param call: its result can be pickled
    :param quietly: whether nothing that is printed there is shown
    :param files: see `Call`
    """

    def __init__(
        self, call: Callable[[CrashLog], Answer], quietly: bool = True, files: RobotFiles | None = None
    ) -> None:
        worker = ForkedWorker(partial(_call_apart, call, (0, 1, 2) if quietly else (0,)))
        super().__init__(worker, worker.close, files)


def begin_call(
    interpreters: Interpreters, work: Callable[[Project, CrashLog], Answer], project: Project, more: int
) -> Call[Answer]:
    """Begin a call in one of these interpreters.

    :param work: as in `run_in_subprocess`
    :param more: how many calls are known to follow
    """
    worker = interpreters.begin(partial(_send_result, partial(work, replace(project))), more)
    return Call(worker, partial(interpreters.end, worker), project.files)


def wait_for_calls(calls: Sequence[Call[Any]]) -> None:
    """Return when at least one of these has something new, or may have ended; take it in."""
    wait_for_any([number for call in calls if (number := call.fileno()) is not None])
    for call in calls:
        call.poll()


def print_standstill(worker: Worker, notice: StandstillNotice, files: RobotFiles) -> None:
    """Print where the code of a process makes no progress, once it is time for that."""
    if not worker.finished and (text := notice.look(worker.standstill(files))) is not None:
        print(text, file=sys.stderr, flush=True)


def _result_of(worker: Worker, files: RobotFiles, meanwhile: str) -> Any:
    for result, error, stack in worker.messages():
        if stack:
            raise (error or RuntimeError("a mistake in pyfrc itself")) from _FailedThere(stack)
        return result
    raise RobotCodeError(worker.describe_exit(files, meanwhile))


# -- on the other side -----------------------------------------------------------------------------------------------


def _call_apart(call: Callable[[CrashLog], object], closed: Sequence[int], send: Send, log: CrashLog) -> None:
    """Do the call, without these standard streams."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started this one
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in closed:
        os.dup2(nowhere, descriptor)
    _send_result(call, send, log)


def _send_result(call: Callable[[CrashLog], object], send: Send, log: CrashLog) -> None:
    """Send the result, the error if the other process can make something of it, and the traceback."""
    try:
        send((call(log), None, ""))
    except (PyfrcError, OSError) as error:
        send((None, error, traceback.format_exc()))
    except Exception:
        send((None, None, traceback.format_exc()))
    except BaseException as error:  # not for the process that asks to be ended by
        send((None, RobotCodeError(text_of(error)), traceback.format_exc()))
