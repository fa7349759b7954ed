"""pyfrc's commands as plug-ins of the `robotpy` command, if that is installed: `robotpy test` is `pyfrc test`.

`robotpy` finds them by their entry points. They pass on all arguments after their name, so that a command has the same
options and exit codes either way.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path


class _PassThrough:
    """A plug-in that runs one of pyfrc's commands."""

    name: str

    def __init__(self, parser: argparse.ArgumentParser) -> None:
        # argparse must not parse any option, not even -h: the command has its own help.
        parser.prefix_chars = "\0"
        parser.add_argument("arguments", nargs=argparse.REMAINDER, help=f"the same as for: pyfrc {self.name}")

    def run(self, main_file: Path, arguments: Sequence[str]) -> int:
        """Run the command on the robot program `main_file`; return its exit code."""
        from .start import become

        words = command_line(self.name, main_file, arguments)
        sys.stdout.flush()
        # A new interpreter: robotpy has imported WPILib in this one.
        return become([sys.executable, "-m", "pyfrc", *words])


class Test(_PassThrough):
    """Run the robot project's tests."""

    name = "test"
    __test__ = False  # pytest: no test class


class Sim(_PassThrough):
    """Simulate the robot."""

    name = "sim"


class Coverage(_PassThrough):
    """Measure which lines of the robot run in another command."""

    name = "coverage"


class Profiler(_PassThrough):
    """Measure how long the robot's functions take in another command."""

    name = "profiler"


class CreatePhysics(_PassThrough):
    """Write a physics.py and sim/config.json that fit the robot."""

    name = "create-physics"


class AddTests(_PassThrough):
    """Add the ready-made tests to the robot project."""

    name = "add-tests"


def command_line(name: str, main_file: Path, arguments: Sequence[str]) -> list[str]:
    """Return the arguments for `pyfrc`.

    :param main_file: the robot program; robotpy passes ``robot.py`` in the current directory when the user has named
        none
    """
    from pyfrc_core.project import MAIN_FILE

    # The project's settings may name another main file, so the project is passed where possible.
    usual = main_file.name == MAIN_FILE
    which = ["--project", str(main_file.parent)] if usual else ["--main", str(main_file)]
    at = _place_of_options(name, arguments)
    return [name, *arguments[:at], *which, *arguments[at:]]


def _place_of_options(name: str, arguments: Sequence[str]) -> int:
    """Return the index for the project's options. Those of a command that wraps another belong to the wrapped one."""
    from .wrapping import WRAPPABLE

    if name not in ("coverage", "profiler"):
        return 0
    wrapped = (at for at, word in enumerate(arguments) if word in WRAPPABLE)
    return next(wrapped, -1) + 1
