"""Frames to and from the agent, with limits of time and size: the robot may be slow, broken, or not a robot.

The agent sends a keep-alive message, ``{"alive": ...}``, every second while it works on a request or receives file
contents. The limits therefore do not depend on the speed of its disk. One applies until the next frame begins, one to a
frame from its first byte to its last, and one to all frames of a response.
"""

from __future__ import annotations

import json
import re
import threading
import time
import zlib
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Protocol, TypeVar

from .. import wheel_files
from ..terminal_text import one_line
from .agent import wire
from .errors import ConnectionFailedError, DeployError, NoPythonError, OtherComputerError, RefusedError
from .responses import Raw, ResponseError, parse_json, value_of
from .robot_checks import PREPARE

#: The maximum size of a response, compressed or not, in bytes: enough for the paths of 50,000 files.
MAX_RESPONSE_BYTES = 1 << 22
#: The maximum number of frames before a response, including keep-alive messages.
MAX_FRAMES = 100_000

#: Printed by the bootstrap of `agent_package`.
_TOO_OLD = re.compile(r"Python \d+\.\d+ is too old")
_RETRY = "The program on the robot is complete. Check the connection and run the command again."


@dataclass(frozen=True)
class TimeLimits:
    """Time limits for the robot, in seconds.

    :param start:    until its first frame begins
    :param silence:  until the next frame begins, while it works
    :param frame:    for one frame from its first byte to its last; enough for the longest frame on a slow link
    :param response: for a response with all frames before it
    """

    start: float = 20.0
    silence: float = 60.0
    frame: float = 60.0
    response: float = 900.0


T = TypeVar("T")


class AgentChannel(Protocol):
    """The part of `paramiko.Channel` that is needed."""

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
    """The laptop's end of the connection to the agent.

    Each method raises `ConnectionFailedError` if the connection is lost or a time limit is exceeded, `RefusedError` if
    the robot refuses a request, and another `DeployError` if a request fails or the robot violates the protocol.

    :param python: the path of the robot's Python
    :param clock: a monotonic clock in seconds, for `limits`
    """

    def __init__(
        self,
        channel: AgentChannel,
        where: str,
        python: str,
        limits: TimeLimits,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._channel = channel
        self._where = where
        self._python = python
        self._clock = clock
        self._unread: dict[str, Any] | None = None
        #: Called with the content of each keep-alive message.
        self.on_keep_alive: Callable[[object], None] | None = None
        self.limits = limits

    def close(self) -> None:
        """Close the connection to the agent, which then ends."""
        with suppress(OSError, EOFError):  # the connection may be lost
            self._channel.close()

    def send_request(self, request: dict[str, Any]) -> None:
        """Send a request. All responses to earlier requests must have been read."""
        if self.has_message():
            raise self.protocol_error("it sent a message without a request")
        self.send(wire.message_frame(request))

    def send(self, data: bytes, *, first: bool = False) -> None:
        """Send bytes.

        :param first: whether they are the first ones: without Python on the robot, the command may already have ended
        """
        self._channel.settimeout(self.limits.start if first else self.limits.silence)
        try:
            self._channel.sendall(data)
        except (OSError, EOFError) as error:
            raise (self._ended(error) if first else self._lost(error)) from error

    def has_message(self) -> bool:
        """Return whether a message has arrived that is not a keep-alive message."""
        while self._unread is None and self._channel.recv_ready():
            message = self._frame(self.limits.silence, self._clock() + self.limits.response)
            self._unread = None if self._is_keep_alive(message) else message
        return self._unread is not None

    def read_message(self, read: Callable[[dict[str, Any]], T]) -> T:
        """Read the next message that is not a keep-alive message.

        :param read: converts it to the result
        """
        return self._read(read, self._next(self.limits.silence, self._clock() + self.limits.response))

    def read_response(
        self,
        read: Callable[[object], T],
        on_message: Callable[[dict[str, Any]], None] | None = None,
        *,
        silence: float | None = None,
        within: float | None = None,
    ) -> T:
        """Read messages until the response.

        :param read: converts ``done`` to the result
        :param on_message: called with each message before the response, except for keep-alive messages; by default,
            such a message is an error
        :param silence: seconds until each frame begins; default: `TimeLimits.silence`
        :param within: seconds for all frames; default: `TimeLimits.response`
        """
        end = self._clock() + (self.limits.response if within is None else within)
        for _ in range(MAX_FRAMES):
            message = self._next(self.limits.silence if silence is None else silence, end)
            if "done" in message:
                return self._read(read, message["done"])
            if on_message is None:
                raise self.protocol_error("it sent a message that is not a response")
            self._read(on_message, message)
        raise self.protocol_error(f"it sent {MAX_FRAMES} frames and no response")

    def _next(self, silence: float, end: float) -> dict[str, Any]:
        if self._unread is not None:
            message, self._unread = self._unread, None
            return message
        for _ in range(MAX_FRAMES):
            message = self._frame(silence, end)
            if not self._is_keep_alive(message):
                return message
        raise self.protocol_error(f"it sent {MAX_FRAMES} keep-alive messages and no response")

    def _read(self, read: Callable[[Any], T], value: object) -> T:
        try:
            return read(value)
        except ResponseError as error:
            raise self.protocol_error(error) from error

    def protocol_error(self, what: object) -> DeployError:
        """Return the error for data that pyfrc's agent does not send."""
        return DeployError(
            f"the robot sent data that is not from pyfrc's agent: {one_line(str(what))}",
            where=self._where,
            remedy="Perhaps a login script on the robot prints something. " + _RETRY,
        )

    def _is_keep_alive(self, message: dict[str, Any]) -> bool:
        if "alive" not in message:
            return False
        if self.on_keep_alive is not None:
            self.on_keep_alive(message["alive"])
        return True

    def read_contents(self, longest: int) -> bytes:
        """Return the piece of a file that the robot sends now.

        :param longest: its maximum, in bytes
        """
        kind, body = self._kind_and_body(self.limits.silence, self._clock() + self.limits.response)
        if kind != wire.CONTENT:
            self._message(kind, body)  # which may be an error
            raise self.protocol_error("it sent a message instead of a piece of a file")
        try:
            return wire.unpack(body, longest)
        except wire.WireError as error:
            raise self.protocol_error(error) from error

    def _frame(self, silence: float, end: float) -> dict[str, Any]:
        return self._message(*self._kind_and_body(silence, end))

    def _kind_and_body(self, silence: float, end: float) -> tuple[bytes, bytes]:
        try:
            reader = _FrameReader(self._receive, self._clock, silence, self.limits.frame, end)
            return wire.read_frame(reader, MAX_RESPONSE_BYTES)
        except wire.EndedError as error:
            raise self._ended(error) from error
        except wire.WireError as error:
            raise self.protocol_error(error) from error

    def _message(self, kind: bytes, body: bytes) -> dict[str, Any]:
        try:
            message = parse_json(wire.unpack_message(kind, body, MAX_RESPONSE_BYTES))
        except (wire.WireError, ResponseError) as error:
            raise self.protocol_error(error) from error
        if "error" in message:
            raise self._error(message)
        return message

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
        what = one_line(str(error)) or ("no response" if isinstance(error, TimeoutError) else "the robot closed it")
        return ConnectionFailedError(f"the connection to the robot was lost: {what}", where=self._where, remedy=_RETRY)

    def _ended(self, error: BaseException) -> DeployError:
        """Return the error for a closed stream, from the exit code and the error output of the command."""
        try:
            self._channel.settimeout(self.limits.start)
            known = self._channel.status_event.wait(self.limits.start)
            status = self._channel.recv_exit_status() if known else -1
            output = self._channel.recv_stderr(65536).decode(errors="replace").strip() if status > 0 else ""
        except (OSError, EOFError):
            status, output = -1, ""
        if status in (126, 127):
            return NoPythonError(
                f"there is no Python on the robot ({self._python})",
                where=self._where,
                remedy=PREPARE,
            )
        if status <= 0:
            return self._lost(error)
        last = output.splitlines()[-1] if output else f"exit code {status}"
        if _TOO_OLD.fullmatch(last):
            return RefusedError(f"the robot's {last}: pyfrc needs 3.9 or newer", where=self._where, remedy=PREPARE)
        return DeployError(f"the agent on the robot has ended: {one_line(last)}", where=self._where, remedy=_RETRY)

    def _error(self, message: dict[str, Any]) -> DeployError:
        message = {"remedy": "", "traceback": "", **message}
        try:
            kind, text, remedy = (value_of(message, key, str) for key in ("error", "message", "remedy"))
            traceback = value_of(message, "traceback", Raw)
        except ResponseError as error:
            return self.protocol_error(error)
        if kind in ("bug", "protocol"):
            last = traceback.strip().splitlines()[-1:]
            return DeployError(": ".join([text, *map(one_line, last)]), where=self._where, remedy=_RETRY)
        refusal = OtherComputerError if kind in ("locked", "replaced") else RefusedError
        return refusal(text, where=self._where, remedy=remedy or None)


class _FrameReader:
    """Reads the bytes of one frame. The first byte changes the time limit."""

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
        self._limit(silence, "no response")

    def __call__(self, count: int) -> bytes:
        read = bytearray()
        while len(read) < count:
            chunk = self._receive(count - len(read), self._deadline - self._clock(), self._why)
            if not chunk:
                break
            if not self._began:
                self._began = True
                self._limit(self._frame, "its response is incomplete")
            read += chunk
        return bytes(read)

    def _limit(self, seconds: float, why: str) -> None:
        self._deadline, self._why = min(
            (self._clock() + seconds, why), (self._end, "it works, but exceeds the time limit")
        )


# The only program in the command line. It reads the agent's modules from standard input and calls `main`.
_BOOTSTRAP = """
import json,sys,types,zlib
if sys.version_info<(3,9):sys.exit("Python "+".".join(map(str,sys.version_info[:2]))+" is too old")
r=open(0,"rb",0)
def g(n):
 b=b""
 while len(b)<n:
  c=r.read(n-len(b))
  if not c:sys.exit("the agent has not arrived")
  b+=c
 return b
for n,s in json.loads(zlib.decompress(g(int(g(8))))):
 t=sys.modules[n]=types.ModuleType(n)
 t.__package__="pyfrc_core.deploy.agent"
 exec(compile(s,n,"exec"),t.__dict__)
t.main(r)
"""
#: In the order of their imports. The bootstrap calls `main` of the last one.
_MODULES = (
    "__init__ system wire activity disk imports layout robot_paths release_record console virtual carrying compiling "
    "environment_files environments releases integrity content_index transaction start_monitor host program logs serve"
)


def agent_command(python: str) -> str:
    """Return the command that loads the agent.

    :param python: the path of the robot's Python
    """
    return f"{python} -X utf8 -u -c '{_BOOTSTRAP}'"


@cache
def agent_package() -> bytes:
    """Return the agent's modules in the format that the bootstrap reads."""
    package = wire.__name__.rpartition(".")[0]
    directory = Path(wire.__file__).parent
    files = {wheel_files.__name__: Path(wheel_files.__file__)}
    files |= {f"{package}.{each}".removesuffix(".__init__"): directory / f"{each}.py" for each in _MODULES.split()}
    modules = [[name, file.read_text("utf-8")] for name, file in files.items()]
    packed = zlib.compress(json.dumps(modules).encode(), 9)
    return b"%08d" % len(packed) + packed
