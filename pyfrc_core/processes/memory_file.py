"""A file for this process and its forks."""

from __future__ import annotations

import os
import tempfile
from typing import IO


def memory_file() -> IO[bytes]:
    """Return an empty file without a name, unbuffered: in memory where the system has such files, else on the disk."""
    if hasattr(os, "memfd_create"):
        try:
            return os.fdopen(os.memfd_create("pyfrc"), "w+b", buffering=0)
        except OSError:  # forbidden in a sandbox
            pass
    return tempfile.TemporaryFile(buffering=0)
