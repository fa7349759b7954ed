"""The agent's compiled code, kept on the robot so that the next deploy need not send and compile it again.

The program that loads it, `agent_package` on the laptop, uses the file only if it is complete, of the same sources and
Python, and if no other user owns it or may write to it.
"""

from __future__ import annotations

import hashlib
import os
from contextlib import suppress

from .robot_paths import RobotPaths


def keep(paths: RobotPaths, code: bytes) -> None:
    """Write the agent's code to the robot's disk, if pyfrc has a directory there. Errors are ignored.

    :param code: the hash of the sources, Python's magic number, and the marshalled code; empty if it was loaded from
        there
    """
    # No other laptop's agent has this name. `Releases.recover` removes what a killed one has left.
    beside = paths.own / f"agent-{os.getpid()}"
    if not code or not paths.own.is_dir():
        return
    try:
        with open(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as stream:  # noqa: PTH123
            stream.write(hashlib.sha256(code).digest() + code)
        beside.replace(paths.agent)
    except OSError:
        with suppress(OSError):
            beside.unlink()
