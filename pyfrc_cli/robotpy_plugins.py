"""Our commands as plug-ins of the `robotpy` command, where that is installed: `robotpy test` is `pyfrc test`.

It finds them by their entry points. They hand on all that stands behind their name as it is, so that a command has the
same options, and the same exit codes, whichever way it is called.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path


class _HandedOn:
    """A plug-in that becomes one of our commands."""

    name: str

    def __init__(self, parser: argparse.ArgumentParser) -> None:
        # So that argparse takes nothing for an option of its own, not even -h: the command has its own help.
        parser.prefix_chars = "\0"
        parser.add_argument("arguments", nargs=argparse.REMAINDER, help=f"as of: pyfrc {self.name}")

    def run(self, main_file: Path, arguments: Sequence[str]) -> int:
        """Run the command on the robot program `main_file`; its exit code."""
        from .start import become

        words = command_line(self.name, main_file, arguments)
        sys.stdout.flush()
        # A new interpreter: robotpy has imported WPILib in this one.
        return become([sys.executable, "-m", "pyfrc", *words])


class Test(_HandedOn):
    """Run the robot project's tests."""

    name = "test"
    __test__ = False  # pytest: no test class


class Sim(_HandedOn):
    """Drive the robot on the desk."""

    name = "sim"


class Coverage(_HandedOn):
    """Measure which lines of the robot run in another command."""

    name = "coverage"


class Profiler(_HandedOn):
    """Measure how long the robot's functions take in another command."""

    name = "profiler"


class CreatePhysics(_HandedOn):
    """Write a physics.py and sim/config.json that fit the robot."""

    name = "create-physics"


class AddTests(_HandedOn):
    """Add the ready-made tests to the robot project."""

    name = "add-tests"


def command_line(name: str, main_file: Path, arguments: Sequence[str]) -> list[str]:
    """What to call `pyfrc` with.

    :param main_file: the robot program that robotpy means: ``robot.py`` here where the user has named none
    """
    from pyfrc_core.project import MAIN_FILE

    # A project may name another main file itself: so it is named as a project where it can be.
    usual = main_file.name == MAIN_FILE
    which = ["--project", str(main_file.parent)] if usual else ["--main", str(main_file)]
    at = _place_of_options(name, arguments)
    return [name, *arguments[:at], *which, *arguments[at:]]


def _place_of_options(name: str, arguments: Sequence[str]) -> int:
    """Where a project's options stand; those of a command that wraps another belong to that one."""
    if name not in ("coverage", "profiler"):
        return 0
    from .main import cli

    context = cli.make_context("pyfrc", [name], resilient_parsing=True)
    command = cli.get_command(context, name)
    assert command is not None
    wrapping = command.make_context(name, list(arguments), parent=context, resilient_parsing=True)
    wrapped = wrapping.params["command_line"] or ()
    return len(arguments) - len(wrapped) + 1 if wrapped else 0
