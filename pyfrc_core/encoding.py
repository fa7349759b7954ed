"""Find and explain text files that are not in UTF-8, the only encoding that Python and TOML read."""

from __future__ import annotations

import codecs
from dataclasses import dataclass
from pathlib import Path

from .file_hash import open_file

_BYTE_ORDER_MARKS = {
    codecs.BOM_UTF32_LE: "UTF-32",  # begins like that of UTF-16
    codecs.BOM_UTF32_BE: "UTF-32",
    codecs.BOM_UTF16_LE: "UTF-16",
    codecs.BOM_UTF16_BE: "UTF-16",
}

_SAVE_AS_UTF_8 = (
    "Save it as UTF-8. In VS Code: click on the encoding at the bottom right, Save with Encoding, UTF-8."
    " (In Windows PowerShell, > writes UTF-16: use | Out-File -Encoding utf8 instead.)"
)


@dataclass(frozen=True)
class WrongEncoding:
    """Why a file cannot be read as UTF-8.

    :param line: the first line that cannot be read, from 1; None when it is the whole file
    """

    line: int | None
    message: str
    remedy: str


def find_wrong_encoding(file: Path) -> WrongEncoding | None:
    """Return what is wrong with the encoding of `file`; None if it is UTF-8 or cannot be read."""
    try:
        with open_file(file) as stream:
            return why_not_utf8(stream.read())
    except OSError:
        return None


def why_not_utf8(content: bytes) -> WrongEncoding | None:
    """Return why this is not the text of a file in UTF-8; None if it is."""
    for mark, name in _BYTE_ORDER_MARKS.items():
        if content.startswith(mark):
            return WrongEncoding(None, f"this file is in {name}, and Python reads UTF-8", _SAVE_AS_UTF_8)
    if b"\0" in content:
        if content.count(b"\0") * 3 > len(content):  # every second byte: UTF-16 without its mark
            return WrongEncoding(None, "this file is in UTF-16, and Python reads UTF-8", _SAVE_AS_UTF_8)
        line = content.count(b"\n", 0, content.index(b"\0")) + 1
        remedy = "The file is damaged, as after a crash of the computer: get it back from git or from a backup."
        return WrongEncoding(line, "this file contains null bytes, which no text has", remedy)
    try:
        content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        byte = content[error.start]
        likely = bytes([byte]).decode("cp1252", "replace")
        character = f", probably the character {likely!r} in Windows' encoding" if likely.isprintable() else ""
        return WrongEncoding(line, f"this line is not UTF-8: it has the byte 0x{byte:02x}{character}", _SAVE_AS_UTF_8)
    return None
