"""The output of the robot program, from the robot's console service or from a command such as ``journalctl``.

Standard library only: the agent on the robot reads it, and so does the laptop.
"""

from __future__ import annotations

import os
import select
import struct
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, NamedTuple, Union

if TYPE_CHECKING:
    import socket
    import subprocess

#: The console's ports: for any client, and for the Driver Station.
PORTS = (1741, 1740)
#: Kinds of messages, the first byte of each.
_ERROR, _TEXT = 11, 12
#: Kinds of messages are below this number. Kinds other than text and error are skipped.
_KINDS = 32
#: The maximum number of empty frames, which keep a connection alive, among what arrives at once.
_MAX_EMPTY_FRAMES = 1000
#: The maximum length of a line that is sent, in bytes.
_MAX_LINE_BYTES = 65000

_LENGTH = struct.Struct(">H")
_TEXT_HEAD = struct.Struct(">BfH")  # kind, time in seconds, number
_ERROR_HEAD = struct.Struct(">BfHHiB")  # kind, time in seconds, number, occurrences, error code, flags

_KEEP_ALIVE = b"\0\0"  # an empty frame
_KEEP_ALIVE_SECONDS = 1.0
#: Seconds to wait for more output after the first, so that several lines are read together.
_BATCH_SECONDS = 0.02


class ConsoleProtocolError(ValueError):
    """The data is not from a robot's console. The message has the reason."""


class ConsoleLine(NamedTuple):
    """A message of a console: seconds since the robot's start, and the text without the newline at its end."""

    seconds: float
    text: str


def text_frame(line: bytes, number: int) -> bytes:
    """Return the frame with a line of output.

    :param number: counts the lines
    """
    body = _TEXT_HEAD.pack(_TEXT, time.monotonic() % 1e6, number % 65536) + line[:_MAX_LINE_BYTES]
    return _LENGTH.pack(len(body)) + body


class ConsoleFrames:
    """The frames of one connection. At most one incomplete frame (64 KiB) is buffered."""

    def __init__(self) -> None:
        self._unread = b""

    def lines(self, received: bytes) -> Iterator[ConsoleLine]:
        """Yield the lines that are complete with the next bytes.

        :raises ConsoleProtocolError: if the data is not from a robot's console
        """
        data, begin, empty = self._unread + received, _LENGTH.size, 0
        while len(data) >= begin:
            end = begin + _LENGTH.unpack_from(data, begin - _LENGTH.size)[0]
            if len(data) > begin and end > begin:
                _check_kind(data[begin])  # also of an incomplete frame, whose rest may never arrive
            if end > len(data):
                break
            empty += end == begin
            if empty > _MAX_EMPTY_FRAMES:
                raise ConsoleProtocolError("it sends too many empty frames")
            if end > begin and (line := _line(data[begin:end])) is not None:
                yield line
            begin = end + _LENGTH.size
        self._unread = data[begin - _LENGTH.size :]


def _check_kind(kind: int) -> None:
    if kind >= _KINDS:
        raise ConsoleProtocolError(f"it sends messages of kind {kind}, which does not exist")


def _line(frame: bytes) -> ConsoleLine | None:
    if frame[0] == _TEXT:
        if len(frame) < _TEXT_HEAD.size:
            raise ConsoleProtocolError(f"it sends a text message of {len(frame)} bytes, which is too short")
        _, seconds, _ = _TEXT_HEAD.unpack_from(frame)
        return ConsoleLine(seconds, frame[_TEXT_HEAD.size :].decode(errors="replace").removesuffix("\n"))
    if frame[0] == _ERROR:
        if len(frame) < _ERROR_HEAD.size:
            raise ConsoleProtocolError(f"it sends an error message of {len(frame)} bytes, which is too short")
        _, seconds, _, _, code, _ = _ERROR_HEAD.unpack_from(frame)
        details, location, stack = _texts(frame, 3)
        return ConsoleLine(seconds, f"{code} {details} {location} {stack}")
    return None


def _texts(frame: bytes, count: int) -> list[str]:
    texts, position = [], _ERROR_HEAD.size
    for _ in range(count):
        start = position + _LENGTH.size
        position = start + _LENGTH.unpack_from(frame, position)[0] if start <= len(frame) else start
        if position > len(frame):
            raise ConsoleProtocolError("it sends an error message with texts longer than the message")
        texts.append(frame[start:position].decode(errors="replace"))
    return texts


class ConsoleClient:
    """A client of a console service.

    :param host: of the robot
    :param ports: to try in turn
    """

    def __init__(self, host: str, ports: Sequence[int]) -> None:
        self._host = host
        self._ports = ports
        self._socket: socket.socket | None = None
        self._frames = ConsoleFrames()
        self._keep_alive = 0.0

    def connect(self, seconds: float = 1.0) -> None:
        """Connect, to receive the output from now on.

        :param seconds: the time limit for each port
        :raises OSError: if none can be reached
        """
        import socket

        self.disconnect()
        for port in self._ports:
            try:
                self._socket = socket.create_connection((self._host, port), timeout=seconds)
                break
            except OSError:
                if port == self._ports[-1]:
                    raise
        assert self._socket is not None
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)

    def disconnect(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()
        self._socket, self._frames = None, ConsoleFrames()

    def lines(self, seconds: float) -> Iterator[ConsoleLine]:
        """Wait up to `seconds` for output, and yield the complete lines that have arrived.

        :raises OSError: if the connection is lost
        :raises ConsoleProtocolError: if the server is not a robot's console
        """
        if self._socket is None:
            raise ConnectionResetError("not connected")
        now = time.monotonic()
        if now >= self._keep_alive:
            with suppress(BlockingIOError):
                self._socket.send(_KEEP_ALIVE)
            self._keep_alive = now + _KEEP_ALIVE_SECONDS
        if select.select([self._socket], [], [], seconds)[0]:
            time.sleep(min(_BATCH_SECONDS, seconds))
            received = self._socket.recv(1 << 18)
            if not received:
                raise ConnectionResetError("closed")
            yield from self._frames.lines(received)

    def receive(self, seconds: float) -> str:
        """Return the same as a text. Without a connection, wait, and return nothing."""
        if self._socket is None:
            time.sleep(seconds)
            return ""
        try:
            return "".join(f"{line.text}\n" for line in self.lines(seconds))
        except (OSError, ConsoleProtocolError):
            self.disconnect()
            return ""


class OutputCommand:
    """A command that prints the program's output, if it can be run. `ConsoleClient` has the same methods.

    :param command: prints the output from its start on, until it is killed
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._command = command
        self._process: subprocess.Popen[bytes] | None = None
        self._unread = b""

    def connect(self) -> None:
        """Start the command, to receive the output from now on."""
        import subprocess

        self.disconnect()
        with suppress(OSError):
            self._process = subprocess.Popen(
                self._command,
                bufsize=0,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )

    def disconnect(self) -> None:
        """Stop the command."""
        if self._process is not None:
            assert self._process.stdout is not None
            self._process.kill()
            self._process.wait()
            self._process.stdout.close()
        self._process, self._unread = None, b""

    def receive(self, seconds: float) -> str:
        """Wait up to `seconds` for output, and return the complete lines that have arrived."""
        if self._process is None:
            time.sleep(seconds)
            return ""
        assert self._process.stdout is not None
        pipe = self._process.stdout.fileno()
        if not select.select([pipe], [], [], seconds)[0]:
            return ""
        time.sleep(min(_BATCH_SECONDS, seconds))
        chunk = os.read(pipe, 1 << 16)
        if not chunk:
            self.disconnect()
            return ""
        lines, newline, self._unread = (self._unread + chunk).rpartition(b"\n")
        return (lines + newline).decode(errors="replace")


Console = Union[ConsoleClient, OutputCommand]  # noqa: UP007 - the agent runs on Python 3.9, too
