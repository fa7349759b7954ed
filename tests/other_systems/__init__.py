"""An environment on Linux in which what Windows, or macOS, lacks is missing: for tests of pyfrc and of robots there.

``make test-like-windows`` runs the suite's files that are about such differences in it (`on_another_system.py`). Each
interpreter that is started there, a command's and a robot's, loads `start/sitecustomize.py`, which is on PYTHONPATH and
calls `install`. One module for each idea:

- `callers`: whose code calls. pyfrc's own, the tests' and a robot's get the other system; the standard library and
  installed packages, which have code of their own for it, keep Linux.
- `imports`: what ``import os`` is for them: the module without the names that the system's Python lacks, with its
  `sys.platform`, and without modules such as `fcntl`. `stand_ins` has what only Windows has, as far as pyfrc uses it.
- `files`: open files, links, names that are reserved, upper and lower case.
- `text`: the encoding and the line ends of text files and of standard streams.
- `processes`: signals, exit codes, how processes are started.
- `clock`: time in steps of 1/64 s.

What it cannot show is in ``CONTRIBUTING.md``.
"""

from __future__ import annotations

import os
from pathlib import Path

#: Set in each process of such an environment: "windows" or "macos".
VARIABLE = "PYFRC_TESTS_ON"

#: Has `sitecustomize.py`.
START = Path(__file__).parent / "start"


def environment() -> dict[str, str]:
    """Return the variables with which a new interpreter is in the environment of this one, if this one is in any."""
    return {"PYTHONPATH": str(START)} if VARIABLE in os.environ else {}


def prepare_streams() -> None:
    """Have the standard streams of a program that was forked, and not started, be as there."""
    if os.environ.get(VARIABLE) == "windows":
        from . import text

        text.prepare_streams()
