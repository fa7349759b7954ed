"""Frames to and from the agent, within limits of time and size: the robot may be slow, broken, or not a robot.

The agent sends a frame ``{"alive": ...}`` every second while it works on an answer, also while it receives
contents. So the limits do not depend on how long a disk takes: one until the next frame begins, one for that frame from
its first byte to its last, and one for all frames of an answer.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from ..terminal_text import one_line
from .agent import wire
from .answers import AnswerError, Fields, parse_json
from .errors import ConnectionFailedError, DeployError, LockedError, NoPythonError, RefusedError
from .preparing import PREPARE

#: The longest answer that is read, packed or not, in bytes. The paths of 50,000 files are within it.
LONGEST_ANSWER = 1 << 22
#: Frames before an answer, signs of life among them: more are a flood.
MOST_FRAMES = 100_000

PYTHON = "/usr/local/bin/python3"
_WHOLE = "No program on the robot is left half written. Check the link and run the command again."


@dataclass(frozen=True)
class TimeLimits:
    """How long the robot may take, in seconds.

    :param start:   until its first frame begins
    :param silence: until the next frame begins, while it works
    :param frame:   for one frame, from its first byte to its last: no less than the longest takes over a slow link
    :param answer:  for an answer as a whole, whatever frames come before it
    """

    start: float = 20.0
    silence: float = 60.0
    frame: float = 60.0
    answer: float = 900.0


T = TypeVar("T")


class Channel(Protocol):
    """What is needed of `paramiko.Channel`."""

    @property
    def status_event(self) -> threading.Event: ...
    def sendall(self, data: bytes, /) -> None: ...
    def recv(self, count: int, /) -> bytes: ...
    def recv_ready(self) -> bool: ...
    def recv_stderr(self, count: int, /) -> bytes: ...
    def recv_exit_status(self) -> int: ...
    def settimeout(self, seconds: float | None, /) -> None: ...
    def close(self) -> None: ...


class AgentStream:
    """The laptop's end of the conversation.

    Each method raises `ConnectionFailedError` when the link is lost or a limit is exceeded, `RefusedError` when the
    robot refuses, and another `DeployError` when it fails or what comes is no frame.

    :param clock: seconds that only grow, for `limits`
    """

    def __init__(
        self, channel: Channel, where: str, limits: TimeLimits, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._channel = channel
        self._where = where
        self._clock = clock
        self._unread: dict[str, Any] | None = None
        #: Called with the value of each sign of life.
        self.on_alive: Callable[[Any], None] | None = None
        self.limits = limits

    def close(self) -> None:
        """End the conversation, and the agent."""
        with suppress(OSError, EOFError):  # the link may be gone
            self._channel.close()

    def ask(self, request: dict[str, Any]) -> None:
        """Send a request, when all answers to those before have been read."""
        if self.has_news():
            raise self.nonsense("something came that was not asked for")
        self.send(wire.said_frame(request))

    def send(self, data: bytes) -> None:
        """Send bytes."""
        self._channel.settimeout(self.limits.silence)
        try:
            self._channel.sendall(data)
        except (OSError, EOFError) as error:
            raise self._lost(error) from error

    def start(self, data: bytes) -> None:
        """Send the first bytes: where there is no Python, the command may have ended before."""
        self._channel.settimeout(self.limits.start)
        try:
            self._channel.sendall(data)
        except (OSError, EOFError) as error:
            raise self._ended(error) from error

    def has_news(self) -> bool:
        """Whether there is something to read that is not a sign of life."""
        while self._unread is None and self._channel.recv_ready():
            said = self._frame(self.limits.silence, self._clock() + self.limits.answer)
            self._unread = None if self._is_alive(said) else said
        return self._unread is not None

    def next(self, parse: Callable[[Fields], T]) -> T:
        """Read the next frame that is not a sign of life.

        :param parse: makes of its fields what is returned
        """
        return self._understood(parse, self._next(self.limits.silence, self._clock() + self.limits.answer))

    def answer(
        self,
        parse: Callable[[Fields], T],
        on_news: Callable[[Fields], None] | None = None,
        *,
        silence: float | None = None,
        within: float | None = None,
    ) -> T:
        """Read frames until the answer.

        :param parse: makes what is returned of the fields of ``done``
        :param on_news: called with each frame before it that is not a sign of life; none: there should be none
        :param silence: seconds until each frame begins; none: the limit for a robot that works
        :param within: seconds for all of it; none: the limit for an answer
        """
        end = self._clock() + (self.limits.answer if within is None else within)
        for _ in range(MOST_FRAMES):
            said = self._next(self.limits.silence if silence is None else silence, end)
            if "done" in said:
                return self._understood(parse, said["done"])
            if on_news is None:
                raise self.nonsense("something came that is no answer")
            self._understood(on_news, said)
        raise self.nonsense(f"{MOST_FRAMES} frames came, and no answer")

    def _next(self, silence: float, end: float) -> dict[str, Any]:
        if self._unread is not None:
            said, self._unread = self._unread, None
            return said
        for _ in range(MOST_FRAMES):
            said = self._frame(silence, end)
            if not self._is_alive(said):
                return said
        raise self.nonsense(f"{MOST_FRAMES} signs of life came, and no answer")

    def _understood(self, parse: Callable[[Fields], T], value: object) -> T:
        try:
            return parse(Fields(value))
        except AnswerError as error:
            raise self.nonsense(error) from error

    def nonsense(self, what: object) -> DeployError:
        """The error for what no agent of ours sends."""
        return DeployError(
            f"what the robot sends is not from our agent: {one_line(str(what))}",
            where=self._where,
            remedy="Perhaps a login script on it prints something. " + _WHOLE,
        )

    def _is_alive(self, said: dict[str, Any]) -> bool:
        if "alive" not in said:
            return False
        if self.on_alive is not None:
            self.on_alive(said["alive"])
        return True

    def _frame(self, silence: float, end: float) -> dict[str, Any]:
        try:
            reading = _Reading(self._receive, self._clock, silence, self.limits.frame, end)
            said = parse_json(wire.text_in(*wire.read_frame(reading, LONGEST_ANSWER), LONGEST_ANSWER))
        except wire.EndedError as error:
            raise self._ended(error) from error
        except (wire.WireError, AnswerError) as error:
            raise self.nonsense(error) from error
        if "error" in said:
            raise self._error(said)
        return said

    def _receive(self, count: int, seconds: float, limit: str) -> bytes:
        if seconds <= 0:
            raise self._lost(TimeoutError(limit))
        self._channel.settimeout(seconds)
        try:
            return self._channel.recv(count)
        except TimeoutError as error:
            raise self._lost(TimeoutError(limit)) from error
        except (OSError, EOFError) as error:
            raise self._lost(error) from error

    def _lost(self, error: BaseException) -> ConnectionFailedError:
        what = one_line(str(error)) or ("no answer" if isinstance(error, TimeoutError) else "the robot closed it")
        return ConnectionFailedError(f"the link to the robot was lost: {what}", where=self._where, remedy=_WHOLE)

    def _ended(self, error: BaseException) -> DeployError:
        """The error for a stream that has ended, by what the robot's shell or Python has written."""
        try:
            self._channel.settimeout(self.limits.start)
            known = self._channel.status_event.wait(self.limits.start)
            status = self._channel.recv_exit_status() if known else -1
            said = self._channel.recv_stderr(65536).decode(errors="replace").strip() if status > 0 else ""
        except (OSError, EOFError):
            status, said = -1, ""
        if status in (126, 127):
            return NoPythonError(
                f"there is no Python on the robot ({PYTHON})",
                where=self._where,
                remedy=PREPARE,
            )
        if status <= 0:
            return self._lost(error)
        last = said.splitlines()[-1] if said else f"exit code {status}"
        return DeployError(f"the agent on the robot has ended: {one_line(last)}", where=self._where, remedy=_WHOLE)

    def _error(self, said: dict[str, Any]) -> DeployError:
        try:
            fields = Fields(said)
            kind, message = fields.line("error"), fields.line("message")
            remedy = fields.line("remedy") if "remedy" in fields else ""
            traceback = fields.text("traceback") if "traceback" in fields else ""
        except AnswerError as error:
            return self.nonsense(error)
        if kind in ("bug", "protocol"):
            last = traceback.strip().splitlines()[-1:]
            return DeployError(": ".join([message, *map(one_line, last)]), where=self._where, remedy=_WHOLE)
        refusal = LockedError if kind == "locked" else RefusedError
        return refusal(message, where=self._where, remedy=remedy or None)


class _Reading:
    """Reads the bytes of one frame: the limit changes with the first of them."""

    def __init__(
        self,
        receive: Callable[[int, float, str], bytes],
        clock: Callable[[], float],
        silence: float,
        frame: float,
        end: float,
    ) -> None:
        self._receive = receive
        self._clock = clock
        self._frame = frame
        self._end = end
        self._began = False
        self._limit(silence, "no answer")

    def __call__(self, count: int) -> bytes:
        read = bytearray()
        while len(read) < count:
            piece = self._receive(count - len(read), self._deadline - self._clock(), self._why)
            if not piece:
                break
            if not self._began:
                self._began = True
                self._limit(self._frame, "its answer began, and did not end")
            read += piece
        return bytes(read)

    def _limit(self, seconds: float, why: str) -> None:
        self._deadline, self._why = min(
            (self._clock() + seconds, why), (self._end, "it works, and does not come to an end")
        )
