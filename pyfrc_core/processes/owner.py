"""Ends this process with the one that owns it, however that ends. Only on Linux: elsewhere, owners end their own."""

from __future__ import annotations

import os
import signal
import sys
from functools import cache
from typing import Any

from .exit import exit_now

_PR_SET_PDEATHSIG = 1


@cache
def _libc() -> Any:
    import ctypes  # not where nothing is started

    return ctypes.CDLL(None)


def prepare_end_with() -> None:
    """Load what `end_with` needs: forks of this process then have it."""
    if sys.platform == "linux":
        _libc().prctl  # noqa: B018 - looked up, and kept


def end_with(owner: int) -> None:
    """Have this process killed when the thread ends that has started it.

    :param owner: the process of that thread. When it has ended already, so does this one; when it is not this
        process's parent, nothing happens.
    """
    if sys.platform != "linux":
        return
    if os.getppid() == owner:
        _libc().prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() == owner:
            return
    try:
        os.kill(owner, 0)
    except ProcessLookupError:
        exit_now(1)
    except PermissionError:  # it exists
        pass
