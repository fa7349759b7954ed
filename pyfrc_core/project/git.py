"""What Git says of a project's checkout."""

from __future__ import annotations

import subprocess
from pathlib import Path


def git_output(directory: Path, *arguments: str, seconds: float) -> str | None:
    """Return the output of a command of Git; None without Git or a checkout, or when it fails or takes too long.

    :param seconds: how long it may take
    """
    try:
        done = subprocess.run(
            ["git", "-C", str(directory), *arguments],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            timeout=seconds,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout
