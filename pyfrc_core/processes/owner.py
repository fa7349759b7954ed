"""Ends this process with the one that owns it, however that ends. Only on Linux: elsewhere, owners end their own."""

from __future__ import annotations

import os
import signal
import sys

from .exit import exit_now

_PR_SET_PDEATHSIG = 1


def end_with(owner: int) -> None:
    """Have this process killed when the thread ends that has started it.

    :param owner: the process of that thread. When it has ended already, so does this one; when it is not this
        process's parent, nothing happens.
    """
    if sys.platform != "linux":
        return
    if os.getppid() == owner:
        import ctypes  # not where nothing is started

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() == owner:
            return
    try:
        os.kill(owner, 0)
    except ProcessLookupError:
        exit_now(1)
    except PermissionError:  # it exists
        pass
