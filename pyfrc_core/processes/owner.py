"""Ends this process with the one that owns it, however that ends. Only on Linux: elsewhere, owners end their own."""

from __future__ import annotations

import os
import sys

from .exit import exit_now


def prepare_end_with() -> None:
    """Import what `end_with` needs: forks of this process then have it."""
    if sys.platform == "linux":
        from ..compat import c_calls  # noqa: F401


def end_with(owner: int) -> None:
    """Have this process killed when the thread ends that has started it.

    :param owner: the process of that thread. When it has ended already, so does this one; when it is not this
        process's parent, nothing happens.
    """
    if sys.platform != "linux":
        return
    from ..compat.c_calls import kill_with_parent  # imported only where something is started

    if os.getppid() == owner:
        kill_with_parent()
        if os.getppid() == owner:
            return
    try:
        os.kill(owner, 0)
    except ProcessLookupError:
        exit_now(1)
    except PermissionError:  # it exists
        pass
