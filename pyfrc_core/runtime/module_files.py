"""The files of all modules, resolved before processes are forked.

commands2 asks `inspect` for the lines where a command is composed. At the first question in a process, `inspect`
resolves the files of all modules, WPILib's and pytest's among them: in each test, and in each match.
"""

from __future__ import annotations

import inspect
import sys
from types import ModuleType

#: Of no module's file: `inspect` looks for it in all of them.
_NOWHERE = compile("", "<nowhere>", "exec")


def resolve_module_files() -> None:
    """Resolve the files of the modules imported so far, if the robot uses commands: forks inherit what is found.

    Nothing is done where a module is an odd one: to ask it for its file could raise an error, or import something.
    """
    if "commands2" in sys.modules and all(map(_is_ordinary, list(sys.modules.values()))):
        inspect.getmodule(_NOWHERE)


def _is_ordinary(module: object) -> bool:
    if not isinstance(module, ModuleType):
        return True  # inspect passes it over
    kind = type(module)
    if kind.__getattribute__ is not ModuleType.__getattribute__:
        return False
    if "__file__" not in vars(module):
        return kind is ModuleType and "__getattr__" not in vars(module)
    file = vars(module)["__file__"]
    return file is None or (type(file) is str and file != "" and "\0" not in file)
