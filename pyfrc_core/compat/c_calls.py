"""The functions of C's libraries that pyfrc calls. Python offers no other way to what they do.

`deploy.agent.system` has its own: it runs on a robot, without pyfrc.
"""

from __future__ import annotations

import ctypes
import signal
import sys

from .cpython_private import SET_ASYNC_EXCEPTION

_PR_SET_PDEATHSIG = 1


def raise_in_thread(ident: int, error: type[BaseException]) -> None:
    """Raise an exception in another thread, as soon as that executes Python code.

    :param ident: of the thread; one that has ended is left alone
    :param error: a class, without arguments, since CPython instantiates it
    """
    SET_ASYNC_EXCEPTION.find()(ctypes.c_ulong(ident), ctypes.py_object(error))


def kill_with_parent() -> None:
    """Have the system kill this process when the thread ends that has started it. Only on Linux."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def draw_sharp_text() -> None:
    """Have Windows leave the windows of this process as they are on screens of high density."""
    if sys.platform == "win32":
        ctypes.windll.shcore.SetProcessDpiAwareness(1)
