"""What the transaction needs of a file system: to have written, to write whole, to swap, to know what is in a file."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from .system import link_file, linked_directory

BLOCK = 1 << 16


def write_whole(file: Path, text: str, mode: int = 0o644) -> None:
    """Write a file so that nobody, not even after a power cut, finds half of it."""
    beside = file.with_name(f".{file.name}.new")
    with beside.open("w", encoding="utf-8", errors="surrogateescape") as stream:
        stream.write(text)
        stream.flush()
        os.fsync(stream.fileno())
    beside.chmod(mode)
    beside.replace(file)


def text_of(file: Path) -> str | None:
    """What is in a text file; none: it is not there."""
    try:
        return file.read_text(encoding="utf-8", errors="surrogateescape")
    except OSError:
        return None


def everything_below(directory: Path) -> Iterator[tuple[str, os.DirEntry[str]]]:
    """All files, links and directories below a directory by their relative names, without Python's caches.

    A directory comes before what is in it.
    """
    waiting = [("", str(directory))]
    while waiting:
        prefix, above = waiting.pop()
        inner = []
        for entry in _entries(above):
            name = prefix + entry.name
            if entry.is_dir(follow_symlinks=False):
                if entry.name == "__pycache__":
                    continue
                inner.append((f"{name}/", entry.path))
            yield name, entry
        waiting += reversed(inner)


def _entries(directory: str) -> list[os.DirEntry[str]]:
    try:
        with os.scandir(directory) as entries:
            return sorted(entries, key=lambda entry: entry.name)
    except OSError:
        return []  # the program has removed it, or it is another user's


def files_below(directory: Path) -> Iterator[tuple[str, os.DirEntry[str]]]:
    """The regular files among `everything_below`."""
    return ((name, entry) for name, entry in everything_below(directory) if entry.is_file(follow_symlinks=False))


def remove(path: Path) -> None:
    """Remove a file or a whole directory, if it is there."""
    if path.is_dir() and linked_directory(path) is None:
        shutil.rmtree(path)
    else:
        with suppress(FileNotFoundError):
            path.unlink()


def remove_if_possible(path: Path) -> None:
    """Remove of a file or directory what we may: others of the robot's users may have put theirs into it."""
    shutil.rmtree(path, ignore_errors=True)


def link_or_copy(source: str, target: str) -> None:
    """Make `target` another name of the file (or link) `source`, or a copy where there can be none."""
    try:
        link_file(source, target)
    except FileNotFoundError:
        raise
    except OSError:
        shutil.copy2(source, target, follow_symlinks=False)


def free_bytes(directory: Path) -> int:
    """The bytes that may still be written in this file system."""
    return shutil.disk_usage(directory).free
