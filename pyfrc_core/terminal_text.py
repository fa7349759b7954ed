"""Make text, also from untrusted sources such as a robot, safe to print in a terminal.

Escape sequences can move the cursor over what was printed before, change the window's title, or have the terminal send
keys; characters for right-to-left text can change the order in which a line is read; invisible characters, such as tags
(U+E0000 to U+E007F), can hide text. They are shown as escapes (``\\x1b``), so that nothing is lost. The joiners
U+200C and U+200D stay, since Persian, Indic scripts and emoji need them, and so do format characters that are visible.
Only sequences that change colours are removed: programs print them for logs.
"""

from __future__ import annotations

import io
import re
from typing import TextIO

_COLOUR = re.compile(r"\x1b\[[0-9;:]*m")
# C0 but for newline and tab, DEL, C1, separators of lines, half characters, and characters of Unicode's category Cf:
# what changes the direction of text, and what is invisible.
_CONTROL = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff"
    "\u00ad\u061c\u180e\u200b\u200e\u200f\u202a-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e007f]"
)


def visible(text: str) -> str:
    """Return the text with control characters as escapes; newlines and tabs stay."""
    return _CONTROL.sub(_escape, _COLOUR.sub("", text.replace("\r\n", "\n")))


def one_line(text: str, longest: int = 1000) -> str:
    """Return the text as one line of no more characters than `longest`, with control characters as escapes."""
    if len(text) > longest:
        text = f"{text[:longest]} ..."
    return visible(text).replace("\n", "\\n").replace("\t", " ")


def escape_unencodable(stream: TextIO) -> None:
    """Let a stream write characters that its encoding lacks as escapes, where Python would raise an exception.

    On Windows, pipes and files have the encoding of the country, and old consoles that of DOS.
    """
    if isinstance(stream, io.TextIOWrapper) and stream.errors in ("strict", "surrogateescape"):
        stream.reconfigure(errors="backslashreplace")


class VisibleStream(io.TextIOBase):
    """Writes text to another stream, with control characters as escapes."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    @property
    def encoding(self) -> str:  # type: ignore[override]
        """The other stream's."""
        return self._stream.encoding

    def write(self, text: str) -> int:
        """Write it."""
        return self._stream.write(visible(text))

    def flush(self) -> None:
        """Flush the other stream. If that was closed before this one is collected, there is nothing to flush."""
        if not self._stream.closed:
            self._stream.flush()


def _escape(found: re.Match[str]) -> str:
    code = ord(found[0])
    if code > 0xFFFF:
        return f"\\U{code:08x}"
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
