"""Check whether a window can be shown here, without importing a GUI toolkit."""

from __future__ import annotations

import importlib.util
import os
import sys

GET_TKINTER = "Install it with your system's package manager: sudo apt install python3-tk, or brew install python-tk."


def has_display() -> bool:
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def has_tkinter() -> bool:
    return importlib.util.find_spec("tkinter") is not None
