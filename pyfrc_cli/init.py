"""The command `pyfrc init`."""

from __future__ import annotations

from pathlib import Path

import click

from pyfrc_core.scaffold import DEFAULT, TEMPLATES, create_project
from pyfrc_core.shell import quoted

from .file_options import WrittenDirectory
from .verbosity import hint


def _show_templates(ctx: click.Context, param: click.Parameter, wanted: bool) -> None:
    """List the templates and exit."""
    if not wanted or ctx.resilient_parsing:
        return
    width = max(map(len, TEMPLATES))
    for name, template in TEMPLATES.items():
        default = " (default)" if name == DEFAULT else ""
        click.echo(f"{name:{width}}  {template.description}{default}")
        if template.packages:
            click.echo(f"{'':{width}}  needs {', '.join(template.packages)}")
    ctx.exit()


@click.command("init", context_settings={"help_option_names": ["-h", "--help"]})
@click.argument("directory", type=WrittenDirectory(), default=Path())
@click.option(
    "-t",
    "--template",
    type=click.Choice(list(TEMPLATES)),
    default=DEFAULT,
    show_default=True,
    help="The kind of robot.",
)
@click.option("--team", type=int, metavar="N", help="Your team number.")
@click.option(
    "--list",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_templates,
    help="Show the templates of the installed season and their descriptions.",
)
def command(directory: Path, template: str, team: int | None) -> None:
    """Create a new robot project in DIRECTORY (default: the current one), with tests and a simulation.

    Existing files are not changed.

    \b
    Exit codes: 0 the project was created, 1 it cannot be written, 2 wrong usage.
    """
    for file in create_project(directory, Path(__file__).parent, template, team):
        hint(f"wrote {directory / file}")
    hint("")
    missing = TEMPLATES[template].missing
    if missing:
        hint(f"It needs packages that are not installed: {', '.join(missing)}")
    if directory != Path():
        hint(f"Go there with: cd {quoted(str(directory))}")
    if missing:
        hint("Install them with: python -m pip install -r requirements.txt")
    hint("Test it with: pyfrc test")
    hint("Drive it with: pyfrc sim")
