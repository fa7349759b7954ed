"""Command lines in messages, spelled for the shell of the user's system: on Windows, PowerShell and cmd."""

from __future__ import annotations

import re
import shlex
import sys

_PLAIN = re.compile(r"[\w.:/\\+=-]+")


def quoted(word: str, system: str = sys.platform) -> str:
    """Return one word of a command line, in quotation marks if the shell needs them.

    :param system: as in `sys.platform`
    """
    if system != "win32":
        return shlex.quote(word)
    return word if _PLAIN.fullmatch(word) else f'"{word}"'  # cmd knows no other marks


def getting_tkinter(system: str = sys.platform) -> str:
    """Return how to get Python's tkinter."""
    if system == "win32":
        return "Run Python's installer again, choose Modify, and tick tcl/tk."
    if system == "darwin":
        return "Install it for Homebrew's Python: brew install python-tk. Python from python.org has it."
    return "Install it with your system's package manager, as in: sudo apt install python3-tk"
