"""What Python has to do before C code ends the process.

Xlib calls C's `exit` when the display goes away: no exception, no `finally`, no `atexit` of Python's. So a function of
C's own `atexit` calls Python. XSetIOErrorHandler would be more direct, but Tk may have its own copy of Xlib.
"""

from __future__ import annotations

import ctypes
import gc
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def calling_at_c_exit(call: Callable[[], object]) -> Iterator[None]:
    """While this lasts, call a function when C code ends the process by `exit`. Only with the GNU C library.

    The function runs on the thread that called `exit`, in the middle of that code: it must not use the library again.
    """
    library = _gnu_library()
    if library is None:
        yield
        return
    armed = True

    def called(argument: object) -> None:
        if armed:
            gc.disable()  # it could destroy what belongs to the code that called `exit`
            call()

    function = ctypes.CFUNCTYPE(None, ctypes.c_void_p)(called)
    # By its address, C knows which functions to remove again: after Python's end none of them may be called.
    handle = ctypes.c_char()
    library.__cxa_atexit(function, None, ctypes.byref(handle))
    try:
        yield
    finally:
        armed = False
        library.__cxa_finalize(ctypes.byref(handle))


def _gnu_library() -> Any:
    try:
        if not (os.confstr("CS_GNU_LIBC_VERSION") or "").startswith("glibc"):
            return None
        library = ctypes.CDLL(None)
        return library if hasattr(library, "__cxa_atexit") and hasattr(library, "__cxa_finalize") else None
    except (AttributeError, ValueError, OSError):  # another system
        return None
