"""Child processes of the virtual robot: each runs in a process group of its own, which ends as a whole.

A robot program may start processes that leave the group. On Linux, they are found by a variable of the program's
environment, which they inherit.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from ..processes.groups import kill_group

#: The variable in the environment of a robot program.
MARK = "PYFRC_VIRTUAL_ROBOT_PROGRAM"
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


def kill_marked(mark: str) -> None:
    """Kill all processes with this value of `MARK` in their environment, except for this one (Linux only)."""
    if sys.platform != "linux":
        return
    wanted = f"{MARK}={mark}".encode()
    found = True
    while found:  # a process may have started another one meanwhile
        found = False
        for entry in Path("/proc").iterdir():
            if not entry.name.isdecimal() or int(entry.name) == os.getpid():
                continue
            with suppress(OSError):  # it has ended, or belongs to another user
                if wanted in (entry / "environ").read_bytes().split(b"\0"):
                    os.kill(int(entry.name), signal.SIGKILL)
                    found = True
