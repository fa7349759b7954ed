"""Child processes of the virtual robot: each runs in a process group of its own, which ends as a whole."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

#: Seconds to wait for a process to end after SIGTERM.
_PATIENCE = 1.0


def start(
    words: Sequence[str], directory: Path, environment: Mapping[str, str], stderr: int
) -> subprocess.Popen[bytes]:
    """Start a process with unbuffered pipes, in a new process group, which Ctrl-C does not reach."""
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
    """Stop a process and its children. Return when it has ended."""
    if process.poll() is None and sys.platform != "win32":
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
        with suppress(subprocess.TimeoutExpired):
            process.wait(_PATIENCE)
    kill_group(process)
    process.wait()


def kill_group(process: subprocess.Popen[bytes]) -> None:
    """Kill the remaining processes of a process group."""
    if sys.platform == "win32":
        if process.poll() is None:
            subprocess.run(["taskkill", "/F", "/T", "/PID", str(process.pid)], capture_output=True, check=False)
    else:
        with suppress(ProcessLookupError, PermissionError):  # on macOS: the group has only zombies
            os.killpg(process.pid, signal.SIGKILL)
