"""What the transaction needs of a file system: to have written, to write whole, to swap, to know what is in a file."""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

BLOCK = 1 << 16
_EXCHANGE = 2
_AT_FDCWD = -100
_RENAMEAT2 = {"x86_64": 316, "armv7l": 382, "aarch64": 276}


def flush(directory: Path) -> None:
    """Wait until all that was written in this file system is on the disk.

    One wait for everything is as safe as one for each file and directory, and much faster on flash memory.
    """
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        library = ctypes.CDLL(None, use_errno=True)
        if not hasattr(library, "syncfs"):
            os.sync()
        elif library.syncfs(descriptor) != 0:
            number = ctypes.get_errno()
            raise OSError(number, os.strerror(number), str(directory))
    finally:
        os.close(descriptor)


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


def exchange(one: Path, other: Path) -> bool:
    """Swap what the two names stand for, at one stroke; false: this system cannot."""
    number = _RENAMEAT2.get(os.uname().machine)
    if number is None:
        return False
    call = ctypes.CDLL(None, use_errno=True).syscall
    return bool(call(number, _AT_FDCWD, os.fsencode(one), _AT_FDCWD, os.fsencode(other), _EXCHANGE) == 0)


def sha256_of(file: Path) -> str:
    """The SHA-256 of a file's content, in hexadecimal."""
    digest = hashlib.sha256()
    with file.open("rb") as stream:
        while block := stream.read(BLOCK):
            digest.update(block)
    return digest.hexdigest()


def everything_below(directory: Path) -> Iterator[tuple[str, Path]]:
    """All files, links and directories below a directory by their relative names, without Python's caches."""
    for above, directories, names in os.walk(directory):
        directories[:] = sorted(each for each in directories if each != "__pycache__")
        for name in [*directories, *sorted(names)]:
            path = Path(above, name)
            yield path.relative_to(directory).as_posix(), path


def files_below(directory: Path) -> Iterator[tuple[str, Path]]:
    """The regular files among `everything_below`."""
    return ((name, path) for name, path in everything_below(directory) if path.is_file() and not path.is_symlink())


def remove(path: Path) -> None:
    """Remove a file or a whole directory, if it is there."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        with suppress(FileNotFoundError):
            path.unlink()


def remove_if_possible(path: Path) -> None:
    """Remove of a file or directory what we may: others of the robot's users may have put theirs into it."""
    shutil.rmtree(path, ignore_errors=True)


def link_or_copy(source: Path, target: Path) -> None:
    """Make `target` another name of the file (or link) `source`, or a copy where there can be none."""
    try:
        os.link(source, target, follow_symlinks=False)
    except FileNotFoundError:
        raise
    except OSError:
        shutil.copy2(source, target, follow_symlinks=False)


def free_bytes(directory: Path) -> int:
    """The bytes that may still be written in this file system."""
    state = os.statvfs(directory)
    return state.f_bavail * state.f_frsize
