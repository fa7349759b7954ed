"""Memory in large pages, in processes that others are forked from.

A fork copies the page tables of all memory, and takes them apart at its end. A process that has imported everything has
20,000 pages of 4 KiB, which takes a fork 4 ms; in pages of 2 MiB, it is half of that or less.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from pathlib import Path

_SIZE = 2 << 20
#: Not yet in `mmap`. Linux before 6.1 does not know it.
_MADV_COLLAPSE = 25


def use_large_pages() -> None:
    """Collect what this process has in memory in large pages, as far as Linux can; before the first fork."""
    maps = Path("/proc/self/maps")
    if not maps.exists():
        return
    madvise = ctypes.CDLL(None).madvise
    madvise.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int]
    for first, end in _private_memory(maps.read_text(errors="replace")):
        for place in range(-(-first // _SIZE) * _SIZE, end - _SIZE + 1, _SIZE):
            madvise(place, _SIZE, _MADV_COLLAPSE)  # an error, as for what was never used, leaves it as it is


def _private_memory(maps: str) -> Iterator[tuple[int, int]]:
    """Yield the addresses, with the one after the last, of memory that can be written and is of no file."""
    for line in maps.splitlines():
        place, access, _, _, _, *name = line.split(maxsplit=5)
        if access == "rw-p" and name in ([], ["[heap]"]):
            first, end = (int(each, 16) for each in place.split("-"))
            yield first, end
