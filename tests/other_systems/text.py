"""Text as Windows has it: cp1252 where no encoding is named, and lines that end in CR LF."""

from __future__ import annotations

import locale
import os
import sys
from typing import Any

ENCODING = "cp1252"


def of_file(mode: str, encoding: str | None, newline: str | None) -> tuple[str, str | None]:
    """Return the encoding and the line ends of a text file that is opened so."""
    if encoding in (None, "locale"):
        encoding = "utf-8" if sys.flags.utf8_mode else ENCODING
    if newline is None and mode[:1] in ("w", "a", "x") and "+" not in mode:
        newline = "\r\n"
    return encoding or ENCODING, newline


def install() -> None:
    """Have standard streams, and what asks for the encoding of this system, use Windows'."""
    if not sys.flags.utf8_mode:
        locale.getencoding = lambda: ENCODING  # type: ignore[attr-defined]
        locale.getpreferredencoding = lambda do_setlocale=True: ENCODING  # type: ignore[assignment]
    prepare_streams()


def prepare_streams() -> None:
    """Have the standard streams of this process use Windows' encoding and line ends."""
    named = "PYTHONIOENCODING" in os.environ or sys.flags.utf8_mode
    for name in ("stdin", "stdout", "stderr"):
        stream: Any = getattr(sys, name)
        if stream is None:
            continue
        if not named and not stream.isatty():  # a console has UTF-8
            errors = "backslashreplace" if name == "stderr" else "strict"
            stream.reconfigure(encoding=ENCODING, errors=errors)
        if name != "stdin":
            stream.reconfigure(newline="\r\n")
