"""Frames over a pair of byte streams: messages in JSON, and compressed chunks of file contents.

A frame is the length of its body (four bytes, big-endian), one byte for its kind, and the body.
"""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Callable
from io import RawIOBase
from typing import Any, BinaryIO

from .system import readable, writable

MESSAGE, CONTENT = b"J", b"C"
HEADER = struct.Struct(">Ic")
#: The maximum length of a frame and of its JSON, in bytes: enough for a manifest of 100,000 files.
MAX_FRAME_BYTES = 1 << 24
#: Bytes in a chunk of file contents.
CHUNK_BYTES = 1 << 15
#: Seconds after which a laptop that holds the deploy lock counts as disconnected.
SILENCE_SECONDS = 20.0
#: A pipe to which anything can be written takes this number of bytes without blocking.
_ATOMIC_BYTES = 4096

Message = dict[str, Any]


class WireError(Exception):
    """The received data is not a valid frame."""


class EndedError(WireError):
    """The stream has ended, possibly in the middle of a frame."""


def frame(kind: bytes, body: bytes) -> bytes:
    """Return the bytes of a frame."""
    return HEADER.pack(len(body), kind) + body


def message_frame(message: Message) -> bytes:
    """Return the bytes of a frame with a message."""
    return frame(MESSAGE, zlib.compress(json.dumps(message, separators=(",", ":")).encode()))


def read_frame(read: Callable[[int], bytes], longest: int = MAX_FRAME_BYTES) -> tuple[bytes, bytes]:
    """Return the kind and body of the next frame.

    :param read: returns the requested number of bytes; fewer only at the end of the stream
    :raises WireError: if the data is not a frame, or the frame is too long
    """
    header = read(HEADER.size)
    if len(header) < HEADER.size:
        raise EndedError("the stream has ended")
    length, kind = HEADER.unpack(header)
    if kind not in (MESSAGE, CONTENT) or length > longest:
        raise WireError(f"this is not a frame: {header!r}")
    body = read(length)
    if len(body) < length:
        raise EndedError("the stream has ended in the middle of a frame")
    return kind, body


def unpack_message(kind: bytes, body: bytes, longest: int = MAX_FRAME_BYTES) -> bytes:
    """Return the JSON text of a message frame."""
    if kind != MESSAGE:
        raise WireError("received file contents instead of a message")
    return unpack(body, longest)


def unpack(body: bytes, longest: int = MAX_FRAME_BYTES) -> bytes:
    """Return what a frame's body holds, compressed."""
    try:
        unpacking = zlib.decompressobj()
        data = unpacking.decompress(body, longest)
    except zlib.error as error:
        raise WireError(f"a frame cannot be read: {error}") from error
    if not unpacking.eof:
        raise WireError("a frame is too long, or is cut short")
    return data


def parse_message(kind: bytes, body: bytes) -> Message:
    """Return the message of a frame."""
    try:
        message = json.loads(unpack_message(kind, body))
    except (ValueError, RecursionError) as error:
        raise WireError(f"a frame cannot be read: {error}") from error
    if not isinstance(message, dict):
        raise WireError("a frame does not hold one JSON object")
    return message


class LaptopPipe(RawIOBase):
    """A pipe to the laptop. A laptop that reads nothing for `SILENCE_SECONDS` counts as disconnected.

    :param descriptor: the pipe's file descriptor
    """

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._limit = SILENCE_SECONDS

    def write(self, data: Any, /) -> int:
        """Write all data.

        :raises ConnectionAbortedError: if the laptop has not read for too long; from then on at once
        """
        left = memoryview(data)
        while left:
            if not writable(self._descriptor, self._limit):
                self._limit = 0.0
                raise ConnectionAbortedError("the laptop does not read")
            left = left[os.write(self._descriptor, left[:_ATOMIC_BYTES]) :]
        return len(data)


class Wire:
    """The robot's end of the connection: standard input and output.

    :param silence_limit: seconds after which a silent laptop counts as disconnected, while `limits_silence` is set
    :param idle_limit: the same at all other times; enough for long tests, and for a user who thinks about a question
    """

    def __init__(
        self,
        source: BinaryIO,
        target: BinaryIO | RawIOBase,
        silence_limit: float = SILENCE_SECONDS,
        idle_limit: float = 1800.0,
    ) -> None:
        self._source = source
        self._target = target
        self._silence_limit = silence_limit
        self._idle_limit = idle_limit
        #: Whether the laptop has to go on at once, since it holds the deploy lock.
        self.limits_silence = False

    def send(self, **message: Any) -> None:
        """Send a message."""
        self._target.write(message_frame(message))
        self._target.flush()

    def send_contents(self, data: bytes) -> None:
        """Send a piece of a file."""
        self._target.write(frame(CONTENT, zlib.compress(data, 1)))
        self._target.flush()

    def receive(self) -> Message:
        """Return the next message. Contents that were already sent when a deploy was refused are skipped."""
        kind, body = read_frame(self._read)
        while kind == CONTENT:
            kind, body = read_frame(self._read)
        return parse_message(kind, body)

    def receive_contents(self) -> bytes:
        """Return the next chunk of file contents, compressed."""
        kind, body = read_frame(self._read)
        if kind != CONTENT:
            raise WireError("received a message instead of file contents")
        return body

    def has_input(self) -> bool:
        """Return whether data has arrived, or the connection is closed."""
        return readable(self._source, 0)

    def _read(self, count: int) -> bytes:
        # The source is unbuffered, so that `readable` detects all data that has arrived.
        chunks = []
        while count:
            limit = self._silence_limit if self.limits_silence else self._idle_limit
            if not readable(self._source, limit):
                raise WireError(f"no data for {limit} s")
            chunk = self._source.read(count)
            if not chunk:
                break
            chunks.append(chunk)
            count -= len(chunk)
        return b"".join(chunks)
