"""A process of its own for robot code: the word that it leaves when it ends too early, and how that is told."""

from __future__ import annotations

import faulthandler
import os
import re
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from itertools import takewhile

from ..robot_files import RobotFiles, is_pyfrc
from .watchdog import EXIT_HANGS

#: Ends the process at once, whatever robot code's `os._exit` is made to do.
exit_now = os._exit

#: Called before this process ends without unwinding its stack; by name.
before_sudden_end: dict[str, Callable[[], object]] = {}

_FAULT_LINE = re.compile(r'File "([^"]+)", line (\d+)')


def write_all(descriptor: int, data: bytes) -> None:
    while data:
        data = data[os.write(descriptor, data) :]


@dataclass(frozen=True)
class LastWords:
    """Where this process leaves word for another one, which gives it to `explain_end`.

    :param descriptor: that of a file open for writing
    """

    descriptor: int

    def write(self, text: str) -> None:
        write_all(self.descriptor, text.encode())

    def leave_on_crash(self, before_exit: Callable[[], object] = lambda: None) -> None:
        """From now on, have a fault in C code and `os._exit` say where they were.

        :param before_exit: called when robot code calls `os._exit`
        """
        faulthandler.enable(self.descriptor, all_threads=False)

        def telling_exit(status: int) -> None:
            frame = sys._getframe(1)
            self.write(
                f'os._exit({status}) was called:\n  File "{frame.f_code.co_filename}", line {frame.f_lineno}'
                f" in {frame.f_code.co_name}\n"
            )
            before_exit()
            call_before_sudden_end()
            exit_now(status)

        os._exit = telling_exit  # type: ignore[assignment]


def call_before_sudden_end() -> None:
    """Call each of `before_sudden_end`, whatever the others raise."""
    for call in list(before_sudden_end.values()):
        with suppress(Exception):
            call()


def explain_end(words: str, status: int, files: RobotFiles, meanwhile: str) -> str:
    """Why a process ended too early: the user's line first, where it can be told.

    :param words: what it has left
    :param status: its exit code; a signal's number, negative
    :param meanwhile: when that was, such as "in the middle of the test"
    """
    words = words.strip()
    if status == EXIT_HANGS and words:
        return words
    if words.startswith("Timeout"):
        what = "the robot code hangs here, in a call that lets nothing else of Python run"
    elif status < 0:
        what = f"the robot's process was ended by signal {-status} ({_signal_name(-status)})"
    else:
        what = f"the robot's process ended itself with exit code {status}, {meanwhile}"
    line = _line_of_crash(words, files)
    # Below the user's code, the stack is pyfrc's and pytest's: of no interest.
    words = "\n".join(takewhile(lambda text: not re.search(r"pyfrc_core|_pytest", text), words.splitlines()))
    return f"{line}: {what}\n\n{words}".strip() if line else f"{what}\n\n{words}".strip()


def _line_of_crash(words: str, files: RobotFiles) -> str | None:
    for stack in re.split(r"^(?=\w*\s?[Tt]hread )", words, flags=re.MULTILINE):
        lines = _FAULT_LINE.findall(stack)
        if not lines or is_pyfrc(lines[0][0]):
            continue  # a thread that only waits for its turn
        for filename, number in lines:
            if files.is_project_file(filename):
                return f"{files.relative(filename)}:{number}"
    return None


def _signal_name(number: int) -> str:
    try:
        name = signal.Signals(number).name
    except ValueError:
        return "unknown"
    return f"{name}, segmentation fault" if name == "SIGSEGV" else name


def end_processes_of_the_robot() -> None:
    """What robot code has started with `multiprocessing` does not outlive this process."""
    multiprocessing = sys.modules.get("multiprocessing")
    for process in multiprocessing.active_children() if multiprocessing is not None else ():
        process.kill()
