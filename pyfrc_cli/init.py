"""`pyfrc init`."""

from __future__ import annotations

import shlex
from pathlib import Path

import click


@click.command("init", context_settings={"help_option_names": ["-h", "--help"]})
@click.argument("directory", type=click.Path(path_type=Path), default=Path())
def command(directory: Path) -> None:
    """Make a new robot project in DIRECTORY (default: here): a tank-drive robot with tests.

    Nothing that is there is overwritten.
    """
    from pyfrc_core.scaffold import create_project

    for file in create_project(directory, Path(__file__).parent):
        click.echo(f"wrote {directory / file}")
    place = "" if directory == Path() else f"cd {shlex.quote(str(directory))} && "
    click.echo(f"\nTest it with: {place}pyfrc test")
