"""Hash files in pieces: a project may have files that do not fit into memory."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

#: Bytes that are read at once: most files of a project are smaller.
_PIECE = 1 << 18


def hash_file(file: Path) -> tuple[str, int]:
    """Return the SHA-256 of a file's content in hexadecimal, and its size in bytes."""
    digest, size = sha256(), 0
    with file.open("rb", buffering=0) as stream:
        while piece := stream.read(_PIECE):
            digest.update(piece)
            size += len(piece)
    return digest.hexdigest(), size
