"""Check whether a window or a person is here, without importing a GUI toolkit."""

from __future__ import annotations

import importlib.util
import os
import sys

#: What to do where no window can be shown.
WITHOUT_DISPLAY = (
    "Use the page in a browser, also of another computer: pyfrc sim. For a window over SSH: ssh -X. "
    "Without either: pyfrc sim --ui none --mode practice."
)


def has_display() -> bool:
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def has_tkinter() -> bool:
    return importlib.util.find_spec("tkinter") is not None


def has_terminal() -> bool:
    """Return whether a person may read what is printed, or type: a program that a script starts may have neither."""
    return any(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stdout))
