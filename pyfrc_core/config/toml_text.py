"""The lines of a TOML file's keys, found by their names: Python's parser does not tell them."""

from __future__ import annotations

import re
from pathlib import Path as File

from .findings import Path, shortened


class TomlText:
    """A TOML file's text, as a `Document`."""

    table = "a table"

    def __init__(self, file: File, text: str) -> None:
        self.name = file.name
        self._lines = text.splitlines()

    def line_of(self, path: Path) -> int | None:
        names = [part for part in path if isinstance(part, str)]
        if not names:
            return None
        setting = re.compile(rf"""^\s*[\["']*(?:[\w.]+\.)?{re.escape(names[-1])}["'\]]*\s*(?:[=:]|$)""")
        return next((number for number, text in enumerate(self._lines, 1) if setting.match(text)), None)

    def excerpt(self, path: Path, value: object) -> str:
        return shortened(repr(value))
