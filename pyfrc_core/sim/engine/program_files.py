"""The files that make up a robot program, and when they were saved."""

from __future__ import annotations

import sys
import time
from contextlib import suppress
from pathlib import Path

from ...project.walk import files_below

#: Directories without robot code.
_NOT_OURS = {"site-packages", "tests", "venv"}
_TWO_SECONDS = 2_000_000_000  # in nanoseconds


def program_files(root: Path) -> dict[str, tuple[int, int]]:
    """Return the Python files and settings below a directory, each with its time (ns) and its size (bytes)."""
    found = {}
    for file in files_below(root, hidden=False):
        if file.suffix != ".py" and file.name not in ("config.json", "pyproject.toml"):
            continue
        if _NOT_OURS.intersection(file.relative_to(root).parts):
            continue
        with suppress(OSError):  # gone again: an editor's temporary file
            status = file.stat()
            found[str(file)] = (status.st_mtime_ns, status.st_size)
    return found


def keep_no_bytecode_of_new_code(root: Path) -> None:
    """Stop this process from writing bytecode when a file of the program may be saved again in the same second.

    That is one which was saved within the last two seconds, or in the future, because the clock was set back. Python
    believes that bytecode fits any source of the same size that was saved in the same second. When a file is saved
    twice within a second, the simulator would continue with the old code.
    """
    newest = max((saved for saved, _ in program_files(root).values()), default=0)
    if time.time_ns() - newest < _TWO_SECONDS:
        sys.dont_write_bytecode = True
