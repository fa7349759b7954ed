"""Format numbers in reports: tables, and nouns with their plural."""

from __future__ import annotations

from collections.abc import Iterator, Sequence


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
