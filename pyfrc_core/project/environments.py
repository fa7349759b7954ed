"""Environments: directories with a Python and installed packages, under any name."""

from __future__ import annotations

from pathlib import Path


def is_environment(directory: str | Path) -> bool:
    """Return whether a directory is a virtual environment or an environment of conda."""
    return Path(directory, "pyvenv.cfg").is_file() or Path(directory, "conda-meta").is_dir()
