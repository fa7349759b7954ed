"""What a process leaves behind when it ends too early, and how that end is described to the user."""

from __future__ import annotations

import contextlib
import faulthandler
import math
import mmap
import os
import re
import struct
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import takewhile

from ..compat.cpython_private import get_frame
from ..patch_table import Patch, PatchTable, patched
from ..project.robot_files import RobotFiles, is_pyfrc
from .crashes import crash_of
from .exit import EXIT_HANGS, exit_now, prepare_sudden_exit
from .standstill import Standstill

_FAULT_LINE = re.compile(r'File "([^"]+)", line (\d+)')

#: What a crash log begins with: this, then the robot time in microseconds, then the name of the mode; then where code
#: makes no progress: for how many seconds, at what robot time, and the place.
#: A process that is killed has no time to write; what it has written to memory that is mapped to a file stays.
_MAGIC = b"\0moment\n"
_MOMENT = struct.Struct("=8sq32s")
_STANDSTILL = struct.Struct("=dd208s")
_HEADER_SIZE = _MOMENT.size + _STANDSTILL.size
_MODE_OFFSET = 16
_NOT_STARTED = -1

#: What each stack begins with that C code writes while no Python code can run. After some of them, the process is not
#: only on a busy machine, or was suspended: each has taken its time.
_NO_PYTHON = "Timeout ("
_HOPELESS_STACKS = 3
#: What is written after stacks that no longer count. They are not removed: Windows does not shorten a mapped file.
_FORGOTTEN = b"\0forgotten\n"

_os_exit = os._exit


@dataclass(frozen=True)
class MomentOfExit:
    """When a robot's process ended.

    :param seconds: robot time
    :param mode: one of `pyfrc_core.wpi.station.MODES`
    """

    seconds: float
    mode: str

    def __str__(self) -> str:
        return f"at {self.seconds:.2f} s in {self.mode} mode"


class CrashLog:
    """Where this process writes what another one gives to `describe_exit`.

    :param descriptor: that of a file open for reading and writing, empty
    """

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor
        #: One 64-bit integer, mapped to the file: the robot time in microseconds. None before `enable`, and where
        #: files cannot be mapped.
        self.time_us: memoryview | None = None
        self._mode: memoryview | None = None
        self._standstill: memoryview | None = None
        #: The size of the file without what has been written since `forget_stacks`.
        self._counted_from = _HEADER_SIZE

    def write(self, text: str) -> None:
        write_all(self.descriptor, text.encode())

    def set_mode(self, name: str) -> None:
        """Note the mode of the robot, which counts when `time_us` is set."""
        if self._mode is not None:
            self._mode[:] = name.encode()[: len(self._mode)].ljust(len(self._mode), b"\0")

    def set_standstill(self, standstill: Standstill | None) -> None:
        """Note where code of this process makes no progress; None: nowhere."""
        if self._standstill is None:
            return
        if standstill is None:
            _STANDSTILL.pack_into(self._standstill, 0, 0.0, 0.0, b"")
        else:
            robot_time = math.nan if standstill.robot_time is None else standstill.robot_time
            _STANDSTILL.pack_into(self._standstill, 0, standstill.seconds, robot_time, standstill.place.encode())

    def forget_stacks(self) -> None:
        """Do not count the stacks any more that C code has written while no Python code could run: it runs again."""
        if self.time_us is not None and os.fstat(self.descriptor).st_size > self._counted_from:
            write_all(self.descriptor, _FORGOTTEN)
            self._counted_from = os.fstat(self.descriptor).st_size

    def enable_fault_handler(self) -> None:
        """Have a fault in C code write its stack here, and nowhere else."""
        faulthandler.enable(self.descriptor, all_threads=False)

    def enable(self) -> None:
        """From now on, write where a fault in C code, or `os._exit`, has ended this process."""
        write_all(self.descriptor, _MOMENT.pack(_MAGIC, _NOT_STARTED, b"") + bytes(_STANDSTILL.size))
        with suppress(OSError, ValueError):
            mapped = memoryview(mmap.mmap(self.descriptor, _HEADER_SIZE))
            self.time_us = mapped[len(_MAGIC) : _MODE_OFFSET].cast("q")
            self._mode, self._standstill = mapped[_MODE_OFFSET : _MOMENT.size], mapped[_MOMENT.size :]
        self.enable_fault_handler()
        here = os.getpid()

        def exit_with_report(status: int) -> None:
            if os.getpid() == here:  # the end of what robot code has forked is not this one's
                frame = get_frame(1)
                self.write(
                    f'os._exit({status}) was called:\n  File "{frame.f_code.co_filename}", line {frame.f_lineno}'
                    f" in {frame.f_code.co_name}\n"
                )
                prepare_sudden_exit()
            exit_now(status)

        PatchTable().patch(os, "_exit", exit_with_report)


@contextlib.contextmanager
def reported_exit(files: RobotFiles) -> Iterator[None]:
    """While robot code is imported in this process, print the line that calls `os._exit`, and the stack of a fault.

    A process with a `CrashLog` does this already.
    """
    if os._exit is not _os_exit:
        yield
        return

    here = os.getpid()

    def exit_with_line(status: int) -> None:
        if os.getpid() != here:
            exit_now(status)
        frame = get_frame(1)
        place = f"{files.relative(frame.f_code.co_filename)}:{frame.f_lineno}"
        print(f"error: {place}: os._exit({status}) was called while the robot's code was imported", file=sys.stderr)
        sys.stderr.flush()
        prepare_sudden_exit()
        exit_now(status or 1)

    faults = not faulthandler.is_enabled()
    if faults:
        with suppress(OSError, ValueError, AttributeError):  # standard error is no file
            faulthandler.enable(all_threads=False)
    try:
        with patched([Patch(os, "_exit", exit_with_line)]):
            yield
    finally:
        if faults:
            faulthandler.disable()


def describe_exit(report: bytes, status: int, files: RobotFiles, meanwhile: str) -> str:
    """Return why a process ended too early: the user's line first, where it is known.

    :param report: the contents of its crash log
    :param status: its exit code; a signal's number, negative
    :param meanwhile: when that was, such as "in the middle of the test"
    """
    moment = moment_of(report)
    text = _text_of(report)
    if status == EXIT_HANGS and text:
        return text
    if text.startswith(_NO_PYTHON):
        text = text[text.rindex(_NO_PYTHON) :]
        what = "the robot code hangs here, in a call that lets nothing else of Python run"
    elif (crash := crash_of(status)) is not None:
        what = f"the robot's process was ended by {crash}"
    else:
        what = f"the robot's process ended itself with exit code {status}, {meanwhile}"
    if moment is not None:
        what += f", {moment}"
    line = _line_of_crash(text, files)
    if not text.startswith("Traceback"):  # below the user's code, the stack is pyfrc's and pytest's: of no interest
        text = "\n".join(takewhile(lambda line: not re.search(r"pyfrc_core|_pytest", line), text.splitlines()))
    return f"{line}: {what}\n\n{text}".strip() if line else f"{what}\n\n{text}".strip()


def moment_of(report: bytes) -> MomentOfExit | None:
    """Return when the process with this crash log ended; None when its robot had not started."""
    if not report.startswith(_MAGIC) or len(report) < _MOMENT.size:
        return None
    _, time_us, mode = _MOMENT.unpack_from(report)
    return None if time_us == _NOT_STARTED else MomentOfExit(time_us / 1_000_000, mode.rstrip(b"\0").decode())


def standstill_of(report: bytes, files: RobotFiles) -> Standstill | None:
    """Return where the code of a process with this crash log makes no progress; None when it does."""
    if not report.startswith(_MAGIC) or len(report) < _HEADER_SIZE:
        return None
    if stacks := _text_of(report).split(_NO_PYTHON)[1:]:
        # Each of them begins with the time after which it was written: 0:00:03
        times = [re.match(r"(\d+):(\d+):(\d+)", stack) for stack in stacks]
        seconds = sum(int(time[1]) * 3600 + int(time[2]) * 60 + int(time[3]) for time in times if time)
        moment = moment_of(report)
        place = _line_of_crash(stacks[-1], files) or "a call that lets nothing else of Python run"
        return Standstill(seconds, place, None if moment is None else moment.seconds, len(stacks) >= _HOPELESS_STACKS)
    seconds, robot_time, place = _STANDSTILL.unpack_from(report, _MOMENT.size)
    if not seconds:
        return None
    known = place.rstrip(b"\0").decode(errors="replace")
    return Standstill(seconds, known, None if math.isnan(robot_time) else robot_time)


def _text_of(report: bytes) -> str:
    written = report[_HEADER_SIZE if report.startswith(_MAGIC) else 0 :]
    return written.rpartition(_FORGOTTEN)[2].decode(errors="replace").strip()


def write_all(descriptor: int, data: bytes) -> None:
    """Write all of `data`, also where one call of the system takes only a part."""
    while data:
        data = data[os.write(descriptor, data) :]


def _line_of_crash(text: str, files: RobotFiles) -> str | None:
    for stack in re.split(r"^(?=\w*\s?[Tt]hread )", text, flags=re.MULTILINE):
        lines = _FAULT_LINE.findall(stack)
        if not lines or is_pyfrc(lines[0][0]):
            continue  # a thread that only waits for its turn
        for filename, number in lines:
            if files.is_project_file(filename):
                return f"{files.relative(filename)}:{number}"
    return None
