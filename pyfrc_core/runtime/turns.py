"""Runs that take turns, because the robot writes files.

Robot code names its files itself: always alike, by the time, or by a random number, and robot time and random numbers
are the same in every run. Runs at the same time would write, rename and delete each other's files. So until a robot has
initialized without writing a file, one run of a command waits for the other; likewise from when a run writes one after
all. Wherever the files are, each run then finds what it would find if it were the only one.

Data logs of WPILib's manager need no turns: `data_logs` gives them names of their own.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

from ..compat.cpython_private import get_frame, outwards
from ..file_lock import lock
from ..project.robot_files import is_pyfrc
from ..temporary import temporary_directory
from .patches.active_run import active_run
from .patches.data_logs import ROBOT_FILE

#: Names the directory by which the processes of a command agree.
_VARIABLE = "PYFRC_TURNS"

_STANDARD_LIBRARY = str(Path(os.__file__).parent) + os.sep
_CHANGING_FILES = frozenset(
    {
        ROBOT_FILE,
        "os.link",
        "os.mkdir",
        "os.remove",
        "os.rename",
        "os.rmdir",
        "os.symlink",
        "os.truncate",
        "sqlite3.connect",
    }
)
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


@contextlib.contextmanager
def taking_turns() -> Iterator[None]:
    """Have the runs take turns that processes started meanwhile begin with `acquire`."""
    if _VARIABLE in os.environ:  # a part of a command that does so already
        yield
        return
    with temporary_directory("turns") as directory:
        os.environ[_VARIABLE] = directory
        try:
            yield
        finally:
            del os.environ[_VARIABLE]


def lock_directory() -> str | None:
    """Return where processes of this command have their lock: for one that was started before `taking_turns`."""
    return os.environ.get(_VARIABLE)


def acquire(directory: str | None = None) -> None:
    """Wait until this process may run the robot, which it may until `release`, or until it ends."""
    global _turn
    # Removed: a command that robot code or a test starts does not wait for this one.
    directory = os.environ.pop(_VARIABLE, directory)
    if directory is not None:
        _turn = _turn or _Turn(Path(directory))
        _turn.begin()


def release() -> None:
    """End the turn of this process, if it has one: its run is over."""
    if _turn is not None:
        _turn.end()


class _Turn:
    """The turn of one process: that of a run until it is given back, or the process ends."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        #: "together" or "alone", once it is known.
        self._how = directory / "how"
        self._wrote = False
        self._file: IO[bytes] | None = None
        sys.addaudithook(self._on_event)
        active_run.when_started = self._on_started

    def begin(self) -> None:
        self._wrote = False
        if self._read_how() != "together":
            self._file = (self._directory / "turn").open("ab")
            lock(self._file)
            if self._read_how() == "together":
                self.end()

    def end(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def _read_how(self) -> str:
        try:
            return self._how.read_text()
        except OSError:
            return ""

    def _on_started(self) -> None:
        if self._file is not None and not self._wrote and self._read_how() != "alone":
            self._how.write_text("together")
            self.end()

    def _on_event(self, event: str, args: tuple[Any, ...]) -> None:
        if self._wrote or not (event in _CHANGING_FILES or (event == "open" and _is_for_writing(*args))):
            return
        run = active_run.run
        if run is not None and run.in_motion and (event == ROBOT_FILE or not _is_ours()):
            self._wrote = True
            with contextlib.suppress(OSError):  # the command is over
                self._how.write_text("alone")


#: That of this process.
_turn: _Turn | None = None


def _is_for_writing(file: object, mode: str | None, flags: int) -> bool:
    return not isinstance(file, int) and file != os.devnull and bool(flags & _WRITING)


def _is_ours() -> bool:
    """Return whether pyfrc itself, or Python's import, changes the file."""
    for call in outwards(get_frame(2)):
        file = call.f_code.co_filename
        if file.startswith("<frozen importlib"):
            return True
        if not file.startswith((_STANDARD_LIBRARY, "<frozen ")) or "site-packages" in file:
            return is_pyfrc(file)
    return True
