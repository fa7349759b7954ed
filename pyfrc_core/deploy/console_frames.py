"""Converts the frames of a robot's console to lines of text, with limited memory.

Another server may listen at the console's port, so each length is checked, and invalid data is an error. The library
`pynetconsole` implements the same protocol, but its thread fails with a traceback on invalid data.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

from .agent.console import ERROR, TEXT, split_frames

#: Kinds of messages are below this number. Kinds other than text and error are skipped.
_KINDS = 32
#: The maximum number of consecutive empty frames, which keep a connection alive. A robot sends few of them.
MAX_EMPTY_FRAMES = 1000

_TEXT_HEAD = struct.Struct(">BfH")  # kind, time in seconds, number
_ERROR_HEAD = struct.Struct(">BfHHiB")  # kind, time in seconds, number, occurrences, error code, flags
_LENGTH = struct.Struct(">H")


class ConsoleProtocolError(ValueError):
    """The data is not from a robot's console. The message has the reason."""


class ConsoleFrames:
    """The frames of one connection. At most one incomplete frame (64 KiB) is buffered."""

    def __init__(self) -> None:
        self._unread = b""
        self._empty = 0

    def lines(self, received: bytes) -> Iterator[str]:
        """Yield the line of each complete frame, without a newline.

        :param received: the next bytes
        :raises ConsoleProtocolError: if the data is not from a robot's console
        """
        frames, self._unread = split_frames(self._unread + received)
        for frame in frames:
            if frame:
                self._empty = 0
                line = _line(frame)
                if line is not None:
                    yield line
            else:
                self._empty += 1
                if self._empty > MAX_EMPTY_FRAMES:
                    raise ConsoleProtocolError("it sends too many empty frames")
        if len(self._unread) > 2:
            _check_kind(self._unread[2])  # checked early, since the rest of the frame may never arrive

    def reset_count(self) -> None:
        """Reset the count of empty frames, after some time has passed."""
        self._empty = 0


def _check_kind(kind: int) -> None:
    if kind >= _KINDS:
        raise ConsoleProtocolError(f"it sends messages of kind {kind}, which does not exist")


def _line(frame: bytes) -> str | None:
    kind = frame[0]
    _check_kind(kind)
    if kind == TEXT:
        if len(frame) < _TEXT_HEAD.size:
            raise ConsoleProtocolError(f"it sends a text message of {len(frame)} bytes, which is too short")
        _, seconds, _ = _TEXT_HEAD.unpack_from(frame)
        return f"[{seconds:.2f}] {_decoded(frame[_TEXT_HEAD.size :])}"
    if kind == ERROR:
        if len(frame) < _ERROR_HEAD.size:
            raise ConsoleProtocolError(f"it sends an error message of {len(frame)} bytes, which is too short")
        _, seconds, _, _, code, _ = _ERROR_HEAD.unpack_from(frame)
        details, location, stack = _texts(frame, 3)
        return f"[{seconds:.2f}] {code} {details} {location} {stack}"
    return None


def _texts(frame: bytes, count: int) -> list[str]:
    texts, position = [], _ERROR_HEAD.size
    for _ in range(count):
        start = position + _LENGTH.size
        position = start + _LENGTH.unpack_from(frame, position)[0] if start <= len(frame) else start
        if position > len(frame):
            raise ConsoleProtocolError("it sends an error message with texts longer than the message")
        texts.append(_decoded(frame[start:position]))
    return texts


def _decoded(text: bytes) -> str:
    return text.decode(errors="replace")
