"""Hash files in pieces: a project may have files that do not fit into memory."""

from __future__ import annotations

import errno
import os
import stat
from contextlib import nullcontext
from hashlib import sha256
from pathlib import Path
from typing import BinaryIO

#: Bytes that are read at once: most files of a project are smaller.
_PIECE = 1 << 18


def open_file(file: Path) -> BinaryIO:
    """Open a file for reading, unbuffered, without waiting for a writer if it has become a pipe.

    :raises OSError: if it cannot be read, or is a pipe, a socket or a device
    """
    stream = open(file, "rb", buffering=0, opener=_without_waiting)  # noqa: SIM115
    if stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
        return stream
    stream.close()
    raise OSError(errno.EINVAL, "this is a pipe, a socket or a device", str(file))


def _without_waiting(file: str, flags: int) -> int:
    return os.open(file, flags | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))


def hash_file(file: Path, copy: Path | None = None) -> tuple[str, int]:
    """Return the SHA-256 of a file's content in hexadecimal, and its size in bytes.

    :param copy: a file that gets the same content
    """
    digest, size = sha256(), 0
    with open_file(file) as stream, nullcontext() if copy is None else copy.open("wb") as target:
        while piece := stream.read(_PIECE):
            digest.update(piece)
            size += len(piece)
            if target is not None:
                target.write(piece)
    return digest.hexdigest(), size
