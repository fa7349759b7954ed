"""File operations of a deploy: atomic writes, directory walks, removal, hard links, free space."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from .system import link_file, linked_directory

BLOCK = 1 << 16


def write_whole(file: Path, text: str, mode: int = 0o644) -> None:
    """Write a file atomically: after a power cut it has the old or the new content."""
    beside = file.with_name(f".{file.name}.new")
    with beside.open("w", encoding="utf-8", errors="surrogateescape") as stream:
        stream.write(text)
        stream.flush()
        os.fsync(stream.fileno())
    beside.chmod(mode)
    beside.replace(file)


def text_of(file: Path) -> str | None:
    """Return the content of a text file, or None if it cannot be read."""
    try:
        return file.read_text(encoding="utf-8", errors="surrogateescape")
    except OSError:
        return None


def everything_below(directory: Path) -> Iterator[tuple[str, os.DirEntry[str]]]:
    """Yield the relative path and entry of each file, link and directory below a directory.

    ``__pycache__`` directories are skipped. A directory comes before its content.
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
        return []  # removed by the program meanwhile, or not readable for this user


def files_below(directory: Path) -> Iterator[tuple[str, os.DirEntry[str]]]:
    """Yield the regular files among `everything_below`."""
    return ((name, entry) for name, entry in everything_below(directory) if entry.is_file(follow_symlinks=False))


def remove(path: Path) -> None:
    """Remove a file or a directory tree, if it exists."""
    if path.is_dir() and linked_directory(path) is None:
        import shutil

        shutil.rmtree(path)
    else:
        with suppress(FileNotFoundError):
            path.unlink()


def remove_if_possible(path: Path) -> None:
    """Remove a directory tree, except for entries that belong to other users of the robot."""
    import shutil

    shutil.rmtree(path, ignore_errors=True)


def link_or_copy(source: str, target: str) -> None:
    """Create `target` as a hard link to `source`, or as a copy if hard links are not supported."""
    try:
        link_file(source, target)
    except FileNotFoundError:
        raise
    except OSError:
        import shutil

        shutil.copy2(source, target, follow_symlinks=False)


def free_bytes(directory: Path) -> int:
    """Return the free space of this file system, in bytes."""
    if sys.platform != "win32":
        state = os.statvfs(directory)
        return state.f_bavail * state.f_frsize
    import shutil

    return shutil.disk_usage(directory).free
