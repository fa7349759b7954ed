"""The files of all modules, resolved before processes are forked.

commands2 asks `inspect` for the lines where a command is composed. At the first question in a process, `inspect`
resolves the files of all modules, which takes 30 ms with WPILib's and pytest's: in each test, and in each match.
"""

from __future__ import annotations

import inspect
import sys

#: Of no module's file: `inspect` looks for it in all of them.
_NOWHERE = compile("", "<nowhere>", "exec")


def resolve_module_files() -> None:
    """Resolve the files of the modules imported so far, if the robot uses commands: forks inherit what is found."""
    if "commands2" in sys.modules:
        inspect.getmodule(_NOWHERE)
