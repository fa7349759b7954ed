"""The command `pyfrc init`."""

from __future__ import annotations

import json
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import click

from pyfrc_core.errors import UsageError
from pyfrc_core.scaffold import DEFAULT, TEMPLATES, create_project
from pyfrc_core.shell import quoted

from .file_options import WrittenDirectory
from .shared_options import can_ask, team_option, yes_option
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


def _confirm(directory: Path, others: list[str]) -> None:
    """Ask whether to create the project beside other files.

    :raises UsageError: if the user does not want that, or cannot be asked
    """
    more = f" and {len(others) - 3} more" if len(others) > 3 else ""
    what = f"{directory.resolve()} has other files: {', '.join(others[:3])}{more}"
    if not (can_ask() and click.confirm(f"{what}.\nCreate the robot project beside them?")):
        raise UsageError(
            f"nothing was written: {what}",
            remedy="Name a new directory, as in: pyfrc init my-robot. To create the project beside them, add --yes.",
        )


def _origin() -> str | None:
    """Return the file or directory that pyfrc was installed from; None if that was a package index."""
    try:
        record = distribution("pyfrc").read_text("direct_url.json")
    except PackageNotFoundError:  # run from a checkout that is not installed
        return None
    url = json.loads(record)["url"] if record else ""
    return url2pathname(urlsplit(url).path) if url.startswith("file:") else None


@click.command("init")
@click.argument("directory", type=WrittenDirectory(), default=Path())
@click.option(
    "-t",
    "--template",
    type=click.Choice(list(TEMPLATES)),
    default=DEFAULT,
    show_default=True,
    help="The kind of robot; --list describes them.",
)
@team_option
@yes_option
@click.option(
    "--list",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_templates,
    help="Show the templates and their descriptions.",
)
def command(directory: Path, template: str, team: int | None, yes: bool) -> None:
    """Create a new robot project in DIRECTORY (default: the current one), with tests and a simulation.

    Existing files are not changed. If the directory has other files, you are asked first.

    \b
    Exit codes: 0 the project was created, 1 it cannot be written, 2 wrong usage.
    """
    confirm = None if yes else _confirm
    for file in create_project(directory, Path(__file__).parent, template, team, confirm):
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
    if (origin := _origin()) is not None:
        hint("Before the first push to GitHub, in the project (docs/how_to/test_on_github.md):")
        hint(f"  python -m pip wheel --no-deps -w wheels {quoted(origin)}")
