"""The files that runs of the robot have written in this process by pyfrc's own code: data logs, traces, recordings."""

from __future__ import annotations

from pathlib import Path

#: Absolute paths.
written_files: set[str] = set()


def note_written(file: Path) -> None:
    """Note that a run has written a file: no test needs what was in it before."""
    written_files.add(str(file.absolute()))
