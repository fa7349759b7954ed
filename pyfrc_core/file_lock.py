"""A lock on an open file, between processes."""

from __future__ import annotations

import sys
import time
from typing import IO


def lock(file: IO[bytes], *, wait: bool = True) -> bool:
    """Take the lock of a file, and return whether this process has it now. It ends when the file is closed.

    :param wait: whether to wait while another process has it
    """
    if sys.platform == "win32":
        import msvcrt

        while True:
            try:
                file.seek(0)
                msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
                return True
            except OSError:
                if not wait:
                    return False
                time.sleep(0.05)
    else:
        import fcntl

        try:
            fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        except BlockingIOError:
            return False
        return True
