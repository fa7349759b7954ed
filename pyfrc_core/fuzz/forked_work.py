"""One function's work in a fork of this process, and what it answers, whatever becomes of the process."""

from __future__ import annotations

import os
import pickle
import signal
import struct
import tempfile
from collections.abc import Callable
from typing import IO, Generic, TypeVar

from ..errors import RobotCodeError, text_of
from ..project import Project
from ..runtime.forks import Fork
from ..runtime.own_process import LastWords, end_processes_of_the_robot, exit_now, explain_end

Answer = TypeVar("Answer")

_LENGTH = struct.Struct("<Q")


class ForkedWork(Generic[Answer]):
    """A function that a fork calls, and what it answers."""

    def __init__(self, do: Callable[[LastWords], Answer]) -> None:
        #: Where the process leaves word when it ends without an answer.
        self._words: IO[bytes] = tempfile.TemporaryFile(buffering=0)  # noqa: SIM115 - closed by `close`
        self._fork = Fork(lambda send: _in_the_fork(do, send, self._words.fileno()))

    @property
    def finished(self) -> bool:
        return self._fork.finished

    def fileno(self) -> int:
        return self._fork.fileno()

    def poll(self) -> None:
        if not self._fork.finished:
            self._fork.poll()

    def close(self) -> None:
        """End it, if it has not ended."""
        self._fork.kill()
        self._words.close()

    def answer(self, project: Project, meanwhile: str) -> Answer:
        """What it has answered.

        :param meanwhile: when that was, such as "in the middle of the match"
        :raises RobotCodeError: when the process ended without an answer
        """
        message = self._fork.message
        # The process may have died in the middle of its answer.
        if len(message) >= _LENGTH.size and len(message) == _LENGTH.size + _LENGTH.unpack_from(message)[0]:
            answer, error = pickle.loads(message[_LENGTH.size :])
            if error is not None:
                raise error
            return answer  # type: ignore[no-any-return]
        self._words.seek(0)
        left = self._words.read().decode(errors="surrogateescape")
        raise RobotCodeError(explain_end(left, self._fork.status, project.files, meanwhile))


def _in_the_fork(do: Callable[[LastWords], object], send: Callable[[bytes], None], words_file: int) -> None:
    """What the forked process does. Never returns."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started this one
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(nowhere, descriptor)
    words = LastWords(words_file)
    words.leave_on_crash()
    answer: object = None
    error: Exception | None = None
    try:
        answer = do(words)
    except Exception as raised:
        error = raised
    except BaseException as raised:  # not for the process that asks to be ended by
        error = RobotCodeError(text_of(raised))
    pickled = _pickled(answer, error)
    send(_LENGTH.pack(len(pickled)) + pickled)
    end_processes_of_the_robot()
    exit_now(0)  # without waiting for what the robot left running


def _pickled(answer: object, error: Exception | None) -> bytes:
    try:
        return pickle.dumps((answer, error))
    except Exception:  # an error of the robot's own making need not be one that travels
        return pickle.dumps((answer, RuntimeError(str(error))))
