"""Frames over a pair of byte streams: JSON for what is said, compressed pieces for contents.

A frame is the length of its body in four bytes (big-endian), one byte for its kind, and the body.
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable
from typing import Any, BinaryIO

from .system import readable

SAID, CONTENT = b"J", b"C"
HEADER = struct.Struct(">Ic")
#: No longer frame, and no longer JSON in one, is taken; in bytes. A manifest of 100,000 files is within it.
LONGEST = 1 << 24
#: Bytes in a piece of contents.
PIECE = 1 << 15

Said = dict[str, Any]


class WireError(Exception):
    """What has come is no frame."""


class EndedError(WireError):
    """The stream has ended, perhaps in the middle of a frame."""


def frame(kind: bytes, body: bytes) -> bytes:
    """A frame as it goes over the wire."""
    return HEADER.pack(len(body), kind) + body


def said_frame(said: Said) -> bytes:
    """A frame with something said."""
    return frame(SAID, zlib.compress(json.dumps(said, separators=(",", ":")).encode()))


def read_frame(read: Callable[[int], bytes], longest: int = LONGEST) -> tuple[bytes, bytes]:
    """The next frame's kind and body; `read` gives exactly so many bytes, fewer only at the end of the stream."""
    header = read(HEADER.size)
    if len(header) < HEADER.size:
        raise EndedError("the stream has ended")
    length, kind = HEADER.unpack(header)
    if kind not in (SAID, CONTENT) or length > longest:
        raise WireError(f"this is no frame: {header!r}")
    body = read(length)
    if len(body) < length:
        raise EndedError("the stream has ended in the middle of a frame")
    return kind, body


def text_in(kind: bytes, body: bytes, longest: int = LONGEST) -> bytes:
    """Return the JSON of what a frame says."""
    if kind != SAID:
        raise WireError("contents have come where something was to be said")
    try:
        unpacking = zlib.decompressobj()
        text = unpacking.decompress(body, longest)
    except zlib.error as error:
        raise WireError(f"a frame cannot be read: {error}") from error
    if not unpacking.eof:
        raise WireError("a frame is too long, or is cut short")
    return text


def said_in(kind: bytes, body: bytes) -> Said:
    """Return what a frame says."""
    try:
        said = json.loads(text_in(kind, body))
    except (ValueError, RecursionError) as error:
        raise WireError(f"a frame cannot be read: {error}") from error
    if not isinstance(said, dict):
        raise WireError("a frame does not hold one JSON object")
    return said


class Wire:
    """The robot's end: standard input and output.

    :param patience: seconds for which a transaction waits for the next byte, before it takes the laptop for gone
    """

    def __init__(self, source: BinaryIO, target: BinaryIO, patience: float = 20.0) -> None:
        self._source = source
        self._target = target
        self._patience = patience
        #: Whether a laptop that says nothing for so long is taken for gone.
        self.impatient = False

    def say(self, **said: Any) -> None:
        """Send something said."""
        self._target.write(said_frame(said))
        self._target.flush()

    def hear(self) -> Said:
        """What is said next; contents that were still under way when a deploy was refused are passed over."""
        kind, body = read_frame(self._read)
        while kind == CONTENT:
            kind, body = read_frame(self._read)
        return said_in(kind, body)

    def content(self) -> bytes:
        """The next piece of contents, compressed."""
        kind, body = read_frame(self._read)
        if kind != CONTENT:
            raise WireError("something was said where contents were to come")
        return body

    def pending(self) -> bool:
        """Whether something has come, or the other end is gone."""
        return readable(self._source, 0)

    def _read(self, count: int) -> bytes:
        # The source is unbuffered, so that `readable` sees all that has come.
        pieces = []
        while count:
            if self.impatient and not readable(self._source, self._patience):
                raise WireError(f"nothing has come for {self._patience} s")
            piece = self._source.read(count)
            if not piece:
                break
            pieces.append(piece)
            count -= len(piece)
        return b"".join(pieces)
