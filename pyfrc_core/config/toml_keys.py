"""The lines of a TOML file's keys and tables, which Python's parser does not report."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

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
