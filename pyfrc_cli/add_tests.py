"""The command `pyfrc add-tests`."""

from __future__ import annotations

from pathlib import Path

import click

from .project_options import chosen_project, from_here, project_option
from .verbosity import hint


@click.command("add-tests")
@project_option
def command(directory: Path | None) -> None:
    """Add the ready-made tests to the robot project, as tests/pyfrc_test.py.

    They run the robot through its modes and a practice match, to check that its code does not crash. An existing file
    is not changed.

    \b
    Exit codes: 0 the file exists, written now or before, 2 wrong usage.
    """
    from pyfrc_core.scaffold import add_tests

    file, written = add_tests(chosen_project(directory), Path(__file__).parent)
    hint(f"wrote {from_here(file)}" if written else f"unchanged: {from_here(file)} (exists)")
    hint("\nRun the tests with: pyfrc test")
