"""The lines of a TOML file's keys, found by their names: Python's parser does not report them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path as File

from .findings import Path, dotted, shortened

_NAME = r"""(?:[\w-]+|"(?:[^"\\]|\\.)*"|'[^']*')"""
_NAMES = rf"{_NAME}(?:\s*\.\s*{_NAME})*"
_TABLE = re.compile(rf"\s*(\[\[?)\s*({_NAMES})\s*\]")
_KEY = re.compile(rf"\s*({_NAMES})\s*=\s*")
#: What a value may consist of: strings, comments, brackets.
_PART = re.compile(
    r"""(\"{3}(?:[^\\]|\\.)*?\"{3,5}|'{3}.*?'{3,5}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')|(\#[^\n]*)|([][{}])""", re.DOTALL
)


class TomlText:
    """A TOML file's text, as a `Document`."""

    table = "a table"

    def __init__(self, file: File, text: str) -> None:
        self.name = file.name
        self._text = text

    def line_of(self, path: Path) -> int | None:
        names = tuple(part for part in path if isinstance(part, str))
        lines: dict[tuple[str, ...], int] = {}
        for keys, line, _ in self._settings():
            for length in range(1, len(keys) + 1):  # [tool.pyfrc.match] is also where "tool" begins
                lines.setdefault(keys[:length], line)
        # A key of an inline table stands where the table does.
        return next((lines[names[:length]] for length in range(len(names), 0, -1) if names[:length] in lines), None)

    def excerpt(self, path: Path, value: object) -> str:
        return shortened(repr(value))

    def repeated(self) -> tuple[str, int, int] | None:
        """The first key or table that is there twice, as its name, its first line and its second."""
        seen: dict[tuple[str, ...], int] = {}
        for keys, line, again in self._settings():
            if keys in seen and not again:
                return dotted(keys), seen[keys], line
            if again:  # an array of tables: each has keys of its own
                seen = {other: at for other, at in seen.items() if other[: len(keys)] != keys}
            seen[keys] = line
        return None

    def _settings(self) -> Iterator[tuple[tuple[str, ...], int, bool]]:
        """Each key and table: its names from the top of the file, its line, whether it is one of an array of tables."""
        table: tuple[str, ...] = ()
        line = 1
        rest = iter(_logical_lines(self._text))
        for text in rest:
            if (header := _TABLE.match(text)) is not None:
                table = _split(header[2])
                yield table, line, header[1] == "[["
            elif (key := _KEY.match(text)) is not None:
                yield table + _split(key[1]), line, False
            line += text.count("\n")


def _split(names: str) -> tuple[str, ...]:
    """``tool."a.b"`` as its names."""
    return tuple(name[1:-1] if name[0] in "\"'" else name for name in re.findall(_NAME, names))


def _logical_lines(text: str) -> Iterator[str]:
    """The lines of a file, with those that a value extends over in one; each ends with its line break."""
    at = 0
    while at < len(text):
        key = _KEY.match(text, at, _end_of_line(text, at))
        end = _end_of_line(text, at) if key is None else _end_of_value(text, key.end())
        yield text[at:end]
        at = end


def _end_of_line(text: str, at: int) -> int:
    return text.find("\n", at) + 1 or len(text)


def _end_of_value(text: str, at: int) -> int:
    """Where the line ends on which the value that begins at `at` does."""
    depth = 0
    while True:
        end = _end_of_line(text, at)
        part = _PART.search(text, at)
        if part is None or (depth <= 0 and part.start() >= end):
            return end if depth <= 0 else len(text)
        if part[3] is not None:
            depth += 1 if part[3] in "[{" else -1
        at = part.end()
