"""A process of its own for robot code: the word that it leaves when it ends too early, and how that is told."""

from __future__ import annotations

import contextlib
import faulthandler
import mmap
import os
import re
import signal
import struct
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import takewhile
from typing import TYPE_CHECKING, Any

from ..project.robot_files import RobotFiles, is_pyfrc
from .hang_detector import EXIT_HANGS

if TYPE_CHECKING:
    from .robot import RobotRun

#: Ends the process at once, whatever robot code's `os._exit` is made to do.
exit_now = os._exit

#: Called before this process ends without unwinding its stack; by name.
before_sudden_end: dict[str, Callable[[], object]] = {}

_FAULT_LINE = re.compile(r'File "([^"]+)", line (\d+)')


def write_all(descriptor: int, data: bytes) -> None:
    while data:
        data = data[os.write(descriptor, data) :]


#: What a file of last words begins with: this, then the robot time in microseconds and the mode, as 64-bit integers.
#: A process that is killed has no time to write; what it has written to memory that is mapped to a file stays.
_MAGIC = b"\0moment\n"
_MOMENT = struct.Struct("=8sqq")
_NOT_STARTED = -1


@dataclass(frozen=True)
class Moment:
    """When a robot's process ended.

    :param seconds: robot time
    :param mode: one of `modes.MODES`
    """

    seconds: float
    mode: str

    def __str__(self) -> str:
        return f"at {self.seconds:.2f} s in {self.mode} mode"


class LastWords:
    """Where this process leaves word for another one, which gives it to `explain_end`.

    :param descriptor: that of a file open for reading and writing, empty
    """

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor
        self._moment: memoryview | None = None
        self._listening: list[object] = []

    def write(self, text: str) -> None:
        write_all(self.descriptor, text.encode())

    def follow(self, run: RobotRun) -> None:
        """From now on, keep the robot time and the mode of this run, which is open, up to date in the file."""
        from ..hal import modes  # not in processes that run no robot

        moment = self._moment
        if moment is None:
            return

        def note_mode(name: str = "", value: Any = None) -> None:
            # Before its first packet, a robot is disabled whatever mode is asked for.
            moment[1] = modes.MODES.index(modes.mode_name() if run.connection.connected else "disabled")

        note_mode()
        moment[0] = run.clock.now_us
        run.clock.moment = moment
        self._listening = modes.when_mode_changes(note_mode)
        run.connection.when_connected.append(note_mode)

    def leave_on_crash(self, before_exit: Callable[[], object] = lambda: None) -> None:
        """From now on, have a fault in C code and `os._exit` say where they were, and `follow` when.

        :param before_exit: called when robot code calls `os._exit`
        """
        write_all(self.descriptor, _MOMENT.pack(_MAGIC, _NOT_STARTED, 0))
        with contextlib.suppress(OSError, ValueError):  # where it cannot be mapped, the moment is not known
            self._moment = memoryview(mmap.mmap(self.descriptor, _MOMENT.size))[len(_MAGIC) :].cast("q")
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


@contextlib.contextmanager
def explained_exit(files: RobotFiles) -> Iterator[None]:
    """While robot code is imported in this process, have `os._exit` name its line, and a fault in C print the stack.

    A process that leaves last words does so already.
    """
    if os._exit is not exit_now:
        yield
        return

    def exit_with_line(status: int) -> None:
        frame = sys._getframe(1)
        place = f"{files.relative(frame.f_code.co_filename)}:{frame.f_lineno}"
        print(f"error: {place}: os._exit({status}) was called while the robot's code was imported", file=sys.stderr)
        sys.stderr.flush()
        call_before_sudden_end()
        exit_now(status or 1)

    faults = not faulthandler.is_enabled()
    if faults:
        with suppress(OSError, ValueError, AttributeError):  # standard error is no file
            faulthandler.enable(all_threads=False)
    os._exit = exit_with_line  # type: ignore[assignment]
    try:
        yield
    finally:
        os._exit = exit_now
        if faults:
            faulthandler.disable()


def call_before_sudden_end() -> None:
    """Call each of `before_sudden_end`, whatever the others raise."""
    for call in list(before_sudden_end.values()):
        with suppress(Exception):
            call()


def explain_end(words: str, status: int, files: RobotFiles, meanwhile: str) -> str:
    """Why a process ended too early: the user's line first, where it can be told.

    :param words: what it has left, bytes that are no text as surrogates
    :param status: its exit code; a signal's number, negative
    :param meanwhile: when that was, such as "in the middle of the test"
    """
    moment = moment_of(words)
    words = _without_moment(words).strip()
    if status == EXIT_HANGS and words:
        return words
    if words.startswith("Timeout"):
        what = "the robot code hangs here, in a call that lets nothing else of Python run"
    elif status < 0:
        what = f"the robot's process was ended by signal {-status} ({_signal_name(-status)})"
    else:
        what = f"the robot's process ended itself with exit code {status}, {meanwhile}"
    if moment is not None:
        what += f", {moment}"
    line = _line_of_crash(words, files)
    # Below the user's code, the stack is pyfrc's and pytest's: of no interest.
    words = "\n".join(takewhile(lambda text: not re.search(r"pyfrc_core|_pytest", text), words.splitlines()))
    return f"{line}: {what}\n\n{words}".strip() if line else f"{what}\n\n{words}".strip()


def moment_of(words: str) -> Moment | None:
    """Return when a process ended that has left these words; None when its robot had not started."""
    left = _bytes_of(words)
    if not left.startswith(_MAGIC) or len(left) < _MOMENT.size:
        return None
    from ..hal.modes import MODES

    _, now_us, mode = _MOMENT.unpack_from(left)
    return None if now_us == _NOT_STARTED else Moment(now_us / 1_000_000, MODES[mode])


def _without_moment(words: str) -> str:
    left = _bytes_of(words)
    return left[_MOMENT.size if left.startswith(_MAGIC) else 0 :].decode(errors="replace")


def _bytes_of(words: str) -> bytes:
    return words.encode(errors="surrogateescape")


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
