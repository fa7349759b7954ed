"""The frames of a robot's console as lines of text, within a limit of memory.

The console's port is open to all, and something else may listen there: each length is checked, and what cannot be
a console's is an error. `pynetconsole`, which speaks this protocol as well, ends its thread with a traceback then.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

from .agent.console import ERROR, TEXT, split_frames

#: Robots' kinds of messages are small numbers. Those of other kinds than text and error are skipped.
_KINDS = 32
#: Frames without content keep a connection alive. A robot sends few of them; more at a time are a flood.
MOST_EMPTY_FRAMES = 1000

_TEXT_HEAD = struct.Struct(">BfH")  # kind, time in seconds, number
_ERROR_HEAD = struct.Struct(">BfHHiB")  # kind, time in seconds, number, occurrences, error code, flags
_LENGTH = struct.Struct(">H")


class NonsenseError(ValueError):
    """The bytes are not those of a robot's console; the text says why."""


class ConsoleFrames:
    """The frames of one connection. It keeps no more than one unfinished frame: 64 KiB."""

    def __init__(self) -> None:
        self._unread = b""
        self._empty = 0

    def lines(self, received: bytes) -> Iterator[str]:
        """Yield the line of each frame that is complete now, without a newline at its end.

        :raises NonsenseError: when this cannot be a robot's console
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
                if self._empty > MOST_EMPTY_FRAMES:
                    raise NonsenseError("it sends empty frames without end")
        if len(self._unread) > 2:
            _check_kind(self._unread[2])  # before the rest of a frame is waited for that may never come

    def rest(self) -> None:
        """Count empty frames from zero again, since some time has passed."""
        self._empty = 0


def _check_kind(kind: int) -> None:
    if kind >= _KINDS:
        raise NonsenseError(f"it sends messages of kind {kind}, which robots do not have")


def _line(frame: bytes) -> str | None:
    kind = frame[0]
    _check_kind(kind)
    if kind == TEXT:
        if len(frame) < _TEXT_HEAD.size:
            raise NonsenseError(f"it sends a text message of {len(frame)} bytes, which is too short")
        _, seconds, _ = _TEXT_HEAD.unpack_from(frame)
        return f"[{seconds:.2f}] {_decoded(frame[_TEXT_HEAD.size :])}"
    if kind == ERROR:
        if len(frame) < _ERROR_HEAD.size:
            raise NonsenseError(f"it sends an error message of {len(frame)} bytes, which is too short")
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
            raise NonsenseError("it sends an error message whose texts are longer than the message")
        texts.append(_decoded(frame[start:position]))
    return texts


def _decoded(text: bytes) -> str:
    return text.decode(errors="replace")
