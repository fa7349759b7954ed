"""Directories for temporary files. Those that a killed process has left are removed by the next one that needs any."""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

_NAME = re.compile(r"pyfrc-[a-z-]+-(\d+)-(\d+)-[^-]+")


def temporary_directory(purpose: str) -> tempfile.TemporaryDirectory[str]:
    """Return a new directory, and remove those whose process has ended.

    :param purpose: a part of its name, such as ``fuzz``
    """
    _remove_left()
    prefix = f"pyfrc-{purpose}-{_numbering()}-{os.getpid()}-"
    return tempfile.TemporaryDirectory(prefix=prefix, ignore_cleanup_errors=True)


def _remove_left() -> None:
    """On Windows, nothing is removed: whether a process runs cannot be found out there in public."""
    if sys.platform == "win32":
        return
    for directory in Path(tempfile.gettempdir()).glob("pyfrc-*"):
        named = _NAME.fullmatch(directory.name)
        if named is not None and int(named[1]) == _numbering() and not _runs(int(named[2])):
            shutil.rmtree(directory, ignore_errors=True)


def _numbering() -> int:
    """Return what the numbers of this process and of others belong to: on Linux, each container has its own."""
    try:
        return Path("/proc/self/ns/pid").stat().st_ino
    except OSError:
        return 0


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # it is another user's
        pass
    return True
