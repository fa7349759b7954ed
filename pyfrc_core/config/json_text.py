"""A JSON file: its content, and the line of each value in it.

Python's `json` parses the text but does not report the positions of values. When a position is needed (for an error or
a warning), the text is scanned a second time with `json`'s `raw_decode`, which returns where the value at an offset
ends. Both passes use Python's own scanner, so they cannot disagree about what is a string.

Only standard JSON is accepted: NaN and Infinity, which Python would read, are errors.
"""

from __future__ import annotations

import codecs
import json
import re
import stat
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path as File
from typing import Any, NamedTuple

from ..errors import SettingsError
from .findings import Path, shortened

#: Deeper nesting is an error: Python's own limit depends on the depth of the caller's stack.
MOST_NESTED = 100
#: Maximum size of a file in bytes; a larger one is not a configuration.
MOST_BYTES = 64 * 2**20

_BLANK = re.compile(r"[ \t\n\r]*")
#: Tokens for finding nesting and constants: strings are skipped, unterminated ones too.
_TOKENS = re.compile(r'"[^"\\]*(?:\\.[^"\\]*)*(?:"|\\?\Z)|[\[{]|[\]}]|NaN|-?Infinity', re.DOTALL)


class JsonMember(NamedTuple):
    """One entry of an object or array, with offsets into the text."""

    key: str | int
    #: Where its key begins; for an item of an array, where the item begins.
    start: int
    value: int
    end: int


class _ConstantError(Exception):
    """NaN or Infinity, which Python's json would take."""


def _refuse(constant: str) -> None:
    raise _ConstantError(constant)


def _whole(digits: str) -> int | float:
    # Python refuses to read thousands of digits; as a float they are infinite, and refused as that.
    return int(digits) if len(digits) <= 300 else float(digits)


def _line_after(text: str, end: int | None = None) -> int:
    """Return the line number, from 1, at the offset `end`; lines end with \\n, \\r\\n or \\r."""
    return text.count("\n", 0, end) + text.count("\r", 0, end) - text.count("\r\n", 0, end) + 1


class JsonText:
    """A JSON file, as a `Document`.

    :param name: the file as the user knows it
    :raises SettingsError: when it cannot be read, is not UTF-8 or is not valid JSON, with the line
    """

    table = "an object"

    def __init__(self, file: File, name: str) -> None:
        self.name = name
        self._text = self._decoded(self._read(file))
        self._known_members: dict[int, list[JsonMember]] = {}
        self._has_repeated_keys = False
        self._decoder = json.JSONDecoder(object_pairs_hook=self._object, parse_int=_whole, parse_constant=_refuse)
        self._check_nesting()
        #: The content of the file.
        self.value = self._parsed()

    # -- places -------------------------------------------------------------------------------------------------

    def line_of(self, path: Path) -> int:
        found = self._follow(path)
        return self._line_at(found[-1].start)

    def has(self, path: Path) -> bool:
        return len(self._follow(path)) == len(path) + 1

    def excerpt(self, path: Path, value: object = None) -> str:
        found = self._follow(path)[-1]
        return shortened(self._text[found.value : found.end])

    def repeated_keys(self) -> Iterator[tuple[Path, int]]:
        """Yield the keys that occur more than once in one object, with the line of the first occurrence."""
        if self._has_repeated_keys:
            yield from self._repeated_below((), self._top.value)

    def _repeated_below(self, path: Path, start: int) -> Iterator[tuple[Path, int]]:
        first: dict[str | int, JsonMember] = {}
        reported = set()
        for member in self._members(start):
            key = member.key
            if first.setdefault(key, member) is not member and key not in reported:
                reported.add(key)
                yield (*path, key), self._line_at(first[key].start)
        for member in {member.key: member for member in self._members(start)}.values():
            if self._text[member.value] in "{[":
                yield from self._repeated_below((*path, member.key), member.value)

    def _follow(self, path: Path) -> list[JsonMember]:
        """Return the entries along `path`, as far as they exist; the last one of a repeated key."""
        found = [self._top]
        for part in path:
            entries = [member for member in self._members(found[-1].value) if member.key == part]
            if not entries:
                break
            found.append(entries[-1])
        return found

    @cached_property
    def _top(self) -> JsonMember:
        start = self._skip_blank(0)
        return JsonMember("", start, start, len(self._text.rstrip()))

    def _members(self, start: int) -> list[JsonMember]:
        if start not in self._known_members:
            self._known_members[start] = list(self._find_members(start))
        return self._known_members[start]

    def _find_members(self, start: int) -> Iterator[JsonMember]:
        """Yield the entries of the object or array at an offset; nothing for other values."""
        text = self._text
        if text[start] not in "{[":
            return
        is_object = text[start] == "{"
        index, at = 0, self._skip_blank(start + 1)
        while text[at] not in "}]":
            begin, key = at, index
            if is_object:
                key, at = self._decoder.raw_decode(text, at)
                at = self._skip_blank(self._skip_blank(at) + 1)  # over the colon
            value = at
            _, end = self._decoder.raw_decode(text, at)
            yield JsonMember(key, begin, value, end)
            at = self._skip_blank(end)
            if text[at] == ",":
                at = self._skip_blank(at + 1)
            index += 1

    def _skip_blank(self, at: int) -> int:
        blank = _BLANK.match(self._text, at)
        return blank.end() if blank else at

    def _line_at(self, offset: int) -> int:
        return _line_after(self._text, offset)

    # -- reading ------------------------------------------------------------------------------------------------

    def _read(self, file: File) -> bytes:
        try:
            status = file.stat()
            if stat.S_ISDIR(status.st_mode):
                raise SettingsError("this is a directory, where a file is expected", where=self.name)
            if not stat.S_ISREG(status.st_mode):
                raise SettingsError("this is not a regular file", where=self.name)
            if status.st_size > MOST_BYTES:
                raise SettingsError(
                    f"the file has {status.st_size} bytes; this cannot be a configuration", where=self.name
                )
            return file.read_bytes()
        except OSError as wrong:
            raise SettingsError(f"the file cannot be read: {wrong.strerror or wrong}", where=self.name) from None

    def _decoded(self, raw: bytes) -> str:
        remedy = "Save the file as UTF-8."
        if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or b"\0" in raw[:4]:
            raise SettingsError("this is UTF-16 or UTF-32 text, not UTF-8", where=f"{self.name}:1", remedy=remedy)
        raw = raw.removeprefix(codecs.BOM_UTF8)
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError as wrong:
            line = _line_after(raw[: wrong.start].decode("utf-8"))
            byte = raw[wrong.start : wrong.start + 1]
            as_latin = ascii(byte.decode("latin-1")) if byte < b"\xa0" else repr(byte.decode("latin-1"))
            raise SettingsError(
                f"the byte 0x{byte.hex()} is not UTF-8 text (in Latin-1 it would be {as_latin})",
                where=f"{self.name}:{line}",
                remedy=remedy,
            ) from None

    def _object(self, pairs: list[tuple[str, object]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) < len(pairs):
            self._has_repeated_keys = True
        return found

    def _parsed(self) -> Any:
        try:
            return self._decoder.decode(self._text)
        except json.JSONDecodeError as wrong:
            raise self._malformed(wrong) from None
        except _ConstantError as constant:
            at = next(token.start() for token in _TOKENS.finditer(self._text) if token[0].endswith(("NaN", "Infinity")))
            raise self._error(f"{constant} is not a number that JSON has", at) from None

    def _check_nesting(self) -> None:
        if self._text.count("[") + self._text.count("{") <= MOST_NESTED:
            return
        depth = 0
        for token in _TOKENS.finditer(self._text):
            depth += (token[0] in "[{") - (token[0] in "]}")
            if depth > MOST_NESTED:
                raise self._error(f"objects and arrays are nested more than {MOST_NESTED} deep", token.start())

    def _malformed(self, wrong: json.JSONDecodeError) -> SettingsError:
        """Return an error that describes the text at the position rather than what the parser expected there."""
        text, at = self._text, wrong.pos
        rest = text[at:].lstrip(" \t\n\r")
        before = text[:at].rstrip(" \t\n\r")
        if not text.strip():
            return self._error("the file is empty", 0)
        if rest[:1] in ("}", "]") and before.endswith(","):
            return self._error("JSON allows no comma before a closing bracket", len(before) - 1)
        if rest.startswith(",") and rest[1:].lstrip(" \t\n\r")[:1] in ("}", "]"):
            return self._error("JSON allows no comma before a closing bracket", at)
        if not rest:
            return self._error("the file ends too early, with something still open", len(before))
        if rest.startswith(("//", "/*", "#")):
            return self._error("JSON has no comments", at)
        if rest.startswith("'"):
            return self._error("JSON has its strings in double quotes", at)
        word = re.match(r"[\w.+-]+|.", rest, re.DOTALL)
        found = shortened(ascii(word[0] if word else ""), 20)
        if wrong.msg.startswith("Expecting"):
            wanted = wrong.msg.removeprefix("Expecting ").replace("property name enclosed", "a key")
            wanted = {"value": "a value", "',' delimiter": "a comma or the closing bracket"}.get(wanted, wanted)
            return self._error(f"expected {wanted.removesuffix(' delimiter')}, found {found}", at)
        if wrong.msg.startswith("Unterminated string"):
            return self._error("a string begins here that does not end", at)
        if wrong.msg.startswith("Extra data"):
            return self._error(f"expected the end of the file, found {found}", at)
        return self._error(f"{wrong.msg[:1].lower()}{wrong.msg[1:].removesuffix(' at').removesuffix(': ')}", at)

    def _error(self, message: str, at: int) -> SettingsError:
        column = at - max(self._text.rfind("\n", 0, at), self._text.rfind("\r", 0, at))
        return SettingsError(f"not valid JSON: {message} (column {column})", where=f"{self.name}:{self._line_at(at)}")
