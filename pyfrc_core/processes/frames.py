"""Objects in a stream of bytes: each a length and a pickle, in the order in which they were sent."""

from __future__ import annotations

import pickle
import struct
from collections.abc import Iterator
from typing import IO, Any

_LENGTH = struct.Struct("<Q")

#: The most bytes of one object: a length beyond it is no length.
MOST_BYTES = 1 << 30


class FrameTooLargeError(ValueError):
    """An object has more than `MOST_BYTES` when it is pickled."""


def encode(content: object) -> bytes:
    """Return an object as a frame.

    :raises FrameTooLargeError: when it is too large to be sent
    """
    payload = pickle.dumps(content)
    if len(payload) > MOST_BYTES:
        raise FrameTooLargeError(f"{len(payload)} bytes are more than the {MOST_BYTES} that one message may have")
    return _LENGTH.pack(len(payload)) + payload


def decode(stream: bytes) -> Iterator[Any]:
    """Return the objects in `stream`, up to a frame that was cut off, or is too large to be one."""
    at = 0
    while at + _LENGTH.size <= len(stream):
        (length,) = _LENGTH.unpack_from(stream, at)
        at += _LENGTH.size
        if length > MOST_BYTES or at + length > len(stream):
            return
        yield pickle.loads(stream[at : at + length])
        at += length


def read_frame(stream: IO[bytes]) -> Any:
    """Return the next object of a stream, of which no byte is read that follows it.

    :raises EOFError: when the stream ends before its end
    """
    (length,) = _LENGTH.unpack(_read_exactly(stream, _LENGTH.size))
    if length > MOST_BYTES:
        raise EOFError("this is not the length of an object")
    return pickle.loads(_read_exactly(stream, length))


def _read_exactly(stream: IO[bytes], size: int) -> bytes:
    data = b""
    while len(data) < size:
        more = stream.read(size - len(data))
        if not more:
            raise EOFError("the stream has ended")
        data += more
    return data
