"""Processes of the virtual robot, each with all that it starts: begun apart from the terminal, and ended together."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

#: Seconds for a process to end by itself when it is asked to.
_PATIENCE = 1.0


def start(
    words: Sequence[str], directory: Path, environment: Mapping[str, str], stderr: int
) -> subprocess.Popen[bytes]:
    """Start a process with unbuffered pipes, in a group of its own: Ctrl-C does not reach it."""
    flags = 0
    if sys.platform == "win32":
        flags = subprocess.CREATE_NEW_PROCESS_GROUP
    return subprocess.Popen(
        words,
        bufsize=0,
        cwd=directory,
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=stderr,
        start_new_session=True,
        creationflags=flags,
    )


def end(process: subprocess.Popen[bytes]) -> None:
    """End a process and what it has started; return when it has ended."""
    if process.poll() is None and sys.platform != "win32":
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
        with suppress(subprocess.TimeoutExpired):
            process.wait(_PATIENCE)
    kill_group(process)
    process.wait()


def kill_group(process: subprocess.Popen[bytes]) -> None:
    """End what is left of a process and of what it has started."""
    if sys.platform == "win32":
        if process.poll() is None:
            subprocess.run(["taskkill", "/F", "/T", "/PID", str(process.pid)], capture_output=True, check=False)
    else:
        with suppress(ProcessLookupError, PermissionError):  # macOS: the group has only ended processes
            os.killpg(process.pid, signal.SIGKILL)
