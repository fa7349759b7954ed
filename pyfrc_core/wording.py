"""Wording of reports: tables, nouns with their plural, names of files."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path


def counted(number: int, noun: str, many: str | None = None) -> str:
    """Return a number with its noun: ``1 line``, ``2,000 lines``; ``2 matches`` where `many` is ``matches``."""
    return f"{number:,} {noun if number == 1 else many or noun + 's'}"


def table(rows: Sequence[Sequence[str]], left: int, left_at_end: int = 0) -> Iterator[str]:
    """Yield the lines of a table; its first `left` and last `left_at_end` columns are left-aligned."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = [
            cell.ljust(width) if at < left or at >= len(row) - left_at_end else cell.rjust(width)
            for at, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        yield ("  " + "  ".join(cells)).rstrip()


def from_here(file: Path) -> str:
    """Return a file's name from the current directory, as a terminal opens it, if it is in there."""
    try:
        return os.path.relpath(file) if file.is_relative_to(Path.cwd()) else str(file)
    except OSError:  # the current directory is gone
        return str(file)


def path_from(directory: Path, file: str | Path) -> str:
    """Return the path of a file relative to a directory, where that is possible."""
    try:
        return os.path.relpath(file, directory)
    except ValueError:  # on Windows: on another drive
        return str(file)


def size_text(count: int) -> str:
    """Return a number of bytes with its unit."""
    if count < 10_000:
        return f"{count} bytes"
    return f"{count / 1000:.0f} kB" if count < 10_000_000 else f"{count / 1e6:.1f} MB"
