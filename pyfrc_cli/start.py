"""Where the `pyfrc` command begins: fixes what must be fixed before Python starts, then runs the command line.

Python orders sets of strings by a number it draws at each start. A robot that goes through such a set does the same
in every run only when that number is fixed; so commands that run robots start Python again with it fixed. This is done
before anything is imported, so that it costs hundredths of a second.
"""

from __future__ import annotations

import os
import sys

_RUN_ROBOTS = {"create-physics", "fuzz", "replay", "test"}


def main() -> None:
    """The entry point."""
    _leave_out_the_users_modules()
    if "PYTHONHASHSEED" not in os.environ and _RUN_ROBOTS.intersection(sys.argv[1:]):
        _start_again()
    try:
        from .main import run

        run()
    except KeyboardInterrupt:  # while it was still being imported: after that, `run` says it
        print("interrupted", file=sys.stderr)
        sys.exit(2)


def _leave_out_the_users_modules() -> None:
    """Take the current directory off Python's path, where ``python -m pyfrc`` has put it.

    A `random.py` beside robot.py would otherwise be imported by our own libraries, before it can be found and named.
    """
    if getattr(sys.flags, "safe_path", False) or not sys.path:
        return
    # Without pathlib, which imports modules that the user's may hide.
    here = os.getcwd()  # noqa: PTH109
    if sys.path[0] in ("", here) and not __file__.startswith(os.path.join(here, "pyfrc_cli", "")):  # noqa: PTH118
        del sys.path[0]


def _start_again() -> None:
    os.environ["PYTHONHASHSEED"] = "0"
    sys.exit(become([sys.executable, *sys.orig_argv[1:]]))


def become(command: list[str]) -> int:
    """Run `command` in this process's place; where it cannot be, wait for it, and answer its exit code."""
    if sys.platform != "win32":
        os.execv(command[0], command)
    # Windows' exec would give the terminal back to the shell while the tests run.
    import subprocess

    return subprocess.call(command)
