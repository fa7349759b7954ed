"""The end of a process with those that it has started."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress

from .spawn import StartedProcess


def kill_group(process: StartedProcess) -> None:
    """Kill a process that leads a group (POSIX: a session) of its own, and what remains of that group.

    On Windows, which has no such groups, only the children of a process that still runs can be found.
    """
    if sys.platform == "win32":
        if process.poll() is None:
            subprocess.run(["taskkill", "/F", "/T", "/PID", str(process.pid)], capture_output=True, check=False)
    else:
        with suppress(ProcessLookupError, PermissionError):  # on macOS: the group has only zombies
            os.killpg(process.pid, signal.SIGKILL)
