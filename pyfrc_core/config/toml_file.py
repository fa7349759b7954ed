"""A TOML file, such as pyproject.toml: its content, and the line of each key in it."""

from __future__ import annotations

import re
import sys
from pathlib import Path as File
from typing import Any

from ..encoding import find_wrong_encoding
from ..errors import SettingsError
from .findings import Path, dotted, shortened
from .toml_keys import toml_keys

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
            raise SettingsError(f"not valid TOML: {malformed}", where=where) from None

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
    if tomllib.loads is not _loads_after_mark:
        tomllib.loads = _loads_after_mark


def _loads_after_mark(text: str, /, **options: Any) -> dict[str, Any]:
    return _loads(text.removeprefix(_BYTE_ORDER_MARK), **options)
