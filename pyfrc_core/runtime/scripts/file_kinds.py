"""What a file is, by its beginning and its name: for files that are given where a log or a script belongs."""

from __future__ import annotations

import re
from difflib import get_close_matches
from pathlib import Path
from struct import Struct

from ...errors import PyfrcError, UsageError
from ...log_formats import LOGS, is_other_form
from ...shell import quoted

#: How much of a file shows what it is, in bytes.
_HEAD = 4096
#: The beginning of the driver station's logs: version, seconds since 1904, and their fraction.
_DS_HEADER = Struct(">iqQ")
#: How many logs of a directory are named.
_MOST_NAMED = 5
#: How JSON begins; tables of TOML begin with a bracket, too.
_JSON = re.compile(rb"\{|\[(\s*\[)*\s*([\"{\]\d-]|true\b|false\b|null\b)")
_UNPACK = "Unpack it first."
#: Beginnings of files, with what they are, and what to do.
_BEGINNINGS: tuple[tuple[tuple[bytes, ...], str, str], ...] = (
    ((b"\x89PNG", b"\xff\xd8\xff", b"GIF8", b"BM"), "a picture", ""),
    ((b"PK\x03\x04",), "a ZIP archive", _UNPACK),
    ((b"\x1f\x8b", b"BZh", b"\xfd7zXZ", b"7z\xbc\xaf", b"\x28\xb5\x2f\xfd", b"Rar!"), "a compressed file", _UNPACK),
    ((b"<!doctype html", b"<!DOCTYPE html", b"<html"), "a web page", "A page that pyfrc wrote opens in a browser."),
    ((b"%PDF",), "a PDF file", ""),
    ((b"WPILOG",), "a WPILib data log", ""),
)


def is_data_log(head: bytes, name: str) -> bool:
    """Return whether a file begins as data logs do: WPILib's, and those in another form."""
    return head.startswith(b"WPILOG") or is_other_form(head, name)


def is_ds_log(head: bytes) -> bool:
    """Return whether a file begins as logs of the driver station do."""
    if len(head) < _DS_HEADER.size:
        return False
    version, seconds, _ = _DS_HEADER.unpack_from(head)
    return bool(0 <= version <= 9 and 2_500_000_000 < seconds < 6_000_000_000)


def read_head(file: Path, what: str, error: type[PyfrcError] = UsageError, name: str | None = None) -> bytes:
    """Return the beginning of a file.

    :param what: what the file should be, such as ``a log``
    :param error: the error; for a file that does not exist, and for a directory, always one of usage
    :param name: for people; by default, the file as it was given
    :raises PyfrcError: when there is no such file, or it cannot be read
    """
    name = name or str(file)
    of_usage = error if issubclass(error, UsageError) else UsageError
    if not file.exists():
        raise of_usage(f"there is no file {file}", remedy=_nearly(file))
    if file.is_dir():
        raise of_usage(f"this is a directory, not {what}", where=name, remedy=_newest_in(file))
    if not file.is_file():
        raise error(f"this is a pipe or a device, not {what}", where=name, remedy="Write it into a file first.")
    try:
        with file.open("rb") as opened:
            return opened.read(_HEAD)
    except OSError as wrong:
        raise error(f"it cannot be read: {(wrong.strerror or str(wrong)).lower()}", where=name) from None


def described(head: bytes, name: str) -> tuple[str, str]:
    """Return what a file is that is not what it should be, such as ``a picture``, and what to do; both may be empty.

    :param head: its beginning
    """
    suffix, start = Path(name).suffix.lower(), head.removeprefix(b"\xef\xbb\xbf").lstrip()
    for beginnings, what, remedy in _BEGINNINGS:
        if start.startswith(beginnings):
            return what, remedy
    is_text = _is_text(head)
    if suffix in (".py", ".pyi") and is_text:
        return "Python code", "pyfrc finds the robot's code by itself."
    if suffix == ".csv" and is_text:
        return "a table", "pyfrc does not read tables."
    if _JSON.match(start) and is_text:
        return "JSON", ""
    if is_ds_log(head):
        return "a log of the driver station", ""
    return ("text" if is_text else "binary data") if head else "", ""


def _is_text(head: bytes) -> bool:
    try:
        return "\0" not in head.decode("utf-8")
    except UnicodeDecodeError as wrong:
        return wrong.start > len(head) - 4 and len(head) == _HEAD  # a letter that goes on after the beginning


def _nearly(file: Path) -> str | None:
    """Return which file may be meant."""
    try:
        names = [each.name for each in file.parent.iterdir() if each.is_file()]
    except OSError:
        return None
    by_lower_case = {name.lower(): name for name in sorted(names)}
    close = get_close_matches(file.name.lower(), by_lower_case, n=1, cutoff=0.8)
    return f"Did you mean {quoted(str(file.with_name(by_lower_case[close[0]])))}?" if close else None


def _newest_in(directory: Path) -> str:
    """Return which logs a directory and those in it have, the newest first."""
    try:
        within = (file for pattern in ("*", "*/*") for file in directory.glob(pattern))
        files = [file for file in within if file.suffix.lower() in LOGS]
        files.sort(key=lambda file: file.stat().st_mtime, reverse=True)
    except OSError as wrong:
        return f"It cannot be read: {(wrong.strerror or str(wrong)).lower()}."
    names = ", ".join(file.relative_to(directory).as_posix() for file in files[:_MOST_NAMED])
    return f"Its newest logs: {names}" if names else "There are no logs in it."
