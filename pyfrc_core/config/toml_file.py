"""A TOML file, such as pyproject.toml: its content, and the line of each key in it.

Python's parser does not report the lines of keys and tables.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path as File
from typing import Any, NamedTuple

from ..encoding import find_wrong_encoding
from ..errors import SettingsError
from ..patch_table import PatchTable
from .findings import Path, dotted, shortened

_NAME = r"""(?:[\w-]+|"(?:[^"\\]|\\.)*"|'[^']*')"""
_NAMES = rf"{_NAME}(?:\s*\.\s*{_NAME})*"
_TABLE = re.compile(rf"\s*(\[\[?)\s*({_NAMES})\s*\]")
_KEY = re.compile(rf"\s*({_NAMES})\s*=\s*")
#: What a value may consist of: strings, comments, brackets.
_PART = re.compile(
    r"""(\"{3}(?:[^\\]|\\.)*?\"{3,5}|'{3}.*?'{3,5}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')|(\#[^\n]*)|([][{}])""", re.DOTALL
)


class TomlKey(NamedTuple):
    """A key, or the header of a table.

    :param names:    the names from the top of the file
    :param line:     its line, from 1
    :param in_array: whether it is the header of one of an array of tables
    """

    names: tuple[str, ...]
    line: int
    in_array: bool


def toml_keys(text: str) -> Iterator[TomlKey]:
    """Yield the keys and tables of a TOML file in its order; of inline tables, only the key that holds them."""
    table: tuple[str, ...] = ()
    line = 1
    for logical_line in _logical_lines(text):
        if (header := _TABLE.match(logical_line)) is not None:
            table = _split(header[2])
            yield TomlKey(table, line, header[1] == "[[")
        elif (key := _KEY.match(logical_line)) is not None:
            yield TomlKey(table + _split(key[1]), line, False)
        line += logical_line.count("\n")


def _split(names: str) -> tuple[str, ...]:
    """Return ``tool."a.b"`` as its names."""
    return tuple(name[1:-1] if name[0] in "\"'" else name for name in re.findall(_NAME, names))


def _logical_lines(text: str) -> Iterator[str]:
    """Yield the lines of a file, those that one value takes up as one; each ends with its line break."""
    at = 0
    while at < len(text):
        key = _KEY.match(text, at, _end_of_line(text, at))
        end = _end_of_line(text, at) if key is None else _end_of_value(text, key.end())
        yield text[at:end]
        at = end


def _end_of_line(text: str, at: int) -> int:
    return text.find("\n", at) + 1 or len(text)


def _end_of_value(text: str, at: int) -> int:
    """Return where the line ends on which the value that begins at `at` ends."""
    depth = 0
    while True:
        end = _end_of_line(text, at)
        part = _PART.search(text, at)
        if part is None or (depth <= 0 and part.start() >= end):
            return end if depth <= 0 else len(text)
        if part[3] is not None:
            depth += 1 if part[3] in "[{" else -1
        at = part.end()


if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_BYTE_ORDER_MARK = "\ufeff"
_loads = tomllib.loads


class TomlFile:
    """A TOML file, as a `Document`.

    :raises SettingsError: when it is not in UTF-8 or not valid, naming the line
    """

    table = "a table"

    def __init__(self, file: File) -> None:
        self.name = file.name
        self._text = _read(file)
        #: What the file contains.
        self.content = self._parsed()

    def table_at(self, *names: str) -> dict[str, Any] | None:
        """Return the table of this name, such as ``"tool", "pyfrc"``; None where there is no such table."""
        found: Any = self.content
        for name in names:
            found = found.get(name)
            if not isinstance(found, dict):
                return None
        return found  # type: ignore[no-any-return]

    def line_of(self, path: Path) -> int | None:
        names = tuple(part for part in path if isinstance(part, str))
        lines: dict[tuple[str, ...], int] = {}
        for key in toml_keys(self._text):
            for length in range(1, len(key.names) + 1):  # [tool.pyfrc.match] is also where "tool" begins
                lines.setdefault(key.names[:length], key.line)
        # A key of an inline table is in the line of that table.
        return next((lines[names[:length]] for length in range(len(names), 0, -1) if names[:length] in lines), None)

    def place_of(self, *names: str) -> str:
        """Return the place of a key, such as ``pyproject.toml:3``."""
        return f"{self.name}:{self.line_of(names)}"

    def excerpt(self, path: Path, value: object) -> str:
        return shortened(repr(value))

    def _parsed(self) -> dict[str, Any]:
        try:
            return tomllib.loads(self._text)
        except tomllib.TOMLDecodeError as malformed:
            repeated = self._repeated()
            if repeated is not None:
                name, first, second = repeated
                what = f"not valid TOML: {name} is there twice, in line {first} and in line {second}"
                remedy = "Leave out one of them, or put what is under both under one."
                raise SettingsError(what, where=f"{self.name}:{second}", remedy=remedy) from None
            line = re.search(r"\(at line (\d+)", str(malformed))
            where = f"{self.name}:{line[1]}" if line else self.name
            wrong = self._text.splitlines()[int(line[1]) - 1] if line else ""
            quoted = _with_quotes(wrong)
            quotes = f"A text needs quotes: write {quoted}" if quoted != wrong else None
            raise SettingsError(f"not valid TOML: {malformed}", where=where, remedy=quotes) from None

    def _repeated(self) -> tuple[str, int, int] | None:
        """Return the first key or table that is there twice: its name, its first line and its second."""
        seen: dict[tuple[str, ...], int] = {}
        for names, line, in_array in toml_keys(self._text):
            if names in seen and not in_array:
                return dotted(names), seen[names], line
            if in_array:  # each table of an array has keys of its own
                seen = {other: at for other, at in seen.items() if other[: len(names)] != names}
            seen[names] = line
        return None


def _with_quotes(line: str) -> str:
    """Return a line with quotes around its values that need them: ``main = "robot.py"``, ``["rev", "navx"]``."""
    key, equals, value = line.partition("#")[0].rstrip().partition("=")
    if re.search("[\"']", value) or "tool" in key:
        return line
    return key + equals + re.sub(r"[^\s,\[\]]+", lambda word: _quoted(word[0]), value)


def _quoted(word: str) -> str:
    is_value = re.fullmatch(r"true|false|[+-]?(inf|nan|[\d_]+(\.\d+)?(e[+-]?\d+)?|0x\w+)|\d+(-\d+)+", word)
    return word if is_value else f'"{word}"'


def _read(file: File) -> str:
    """Return the text of a TOML file, without a byte-order mark.

    :raises SettingsError: when it is not in UTF-8
    """
    wrong = find_wrong_encoding(file)
    if wrong is not None:
        where = f"{file.name}:{wrong.line}" if wrong.line else file.name
        raise SettingsError(f"not valid TOML: {wrong.message}", where=where, remedy=wrong.remedy)
    text = file.read_text("utf-8")
    if text.startswith(_BYTE_ORDER_MARK):
        _accept_byte_order_marks()
    return text.removeprefix(_BYTE_ORDER_MARK)


def _accept_byte_order_marks() -> None:
    """Have this process accept a byte-order mark in TOML: pytest and coverage read the same pyproject.toml."""
    PatchTable().patch(tomllib, "loads", _loads_after_mark)


def _loads_after_mark(text: str, /, **options: Any) -> dict[str, Any]:
    return _loads(text.removeprefix(_BYTE_ORDER_MARK), **options)
