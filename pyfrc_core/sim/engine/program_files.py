"""The files that make up a robot program, and when they were saved."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

from ...project.environments import is_environment

#: Directories without robot code.
_NOT_OURS = {"__pycache__", "node_modules", "site-packages", "tests", "venv"}
_TWO_SECONDS = 2_000_000_000  # in nanoseconds


def program_files(root: Path) -> dict[str, tuple[int, int]]:
    """Return the Python files and settings below a directory, each with its time (ns) and its size (bytes)."""
    found = {}
    for directory, below, files in os.walk(root):
        below[:] = [
            name
            for name in below
            if name not in _NOT_OURS and not name.startswith(".") and not is_environment(Path(directory, name))
        ]
        for name in files:
            if name.endswith(".py") or name in ("config.json", "pyproject.toml"):
                try:
                    status = Path(directory, name).stat()
                except OSError:  # gone again: an editor's temporary file
                    continue
                found[str(Path(directory, name))] = (status.st_mtime_ns, status.st_size)
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
