"""The command `pyfrc config`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import chosen_project, project_option
from .verbosity import hint

if TYPE_CHECKING:
    from pyfrc_core.config.sim_file import LoadedSimConfig


@click.group("config")
def command() -> None:
    """Check sim/config.json, which the physics and the simulator read."""


@command.command("check")
@project_option
@click.option("--strict", is_flag=True, help="Fail on warnings, for example in continuous integration.")
def check(directory: Path | None, strict: bool) -> None:
    """Check sim/config.json for mistakes, keys without effect, and implausible values.

    \b
    Exit codes: 0 no mistakes, 1 there are warnings (with --strict), 2 there are mistakes.
    """
    from pyfrc_core.config.findings import MOST_TOLD
    from pyfrc_core.wording import counted

    loaded = _loaded(directory)
    warnings = [*loaded.warnings, *loaded.lint()]
    for warning in warnings:
        click.secho(f"warning: {warning}", fg="yellow")
    what = "no mistakes" if loaded.text else "the file does not exist, so all values are defaults"
    if warnings:
        many = len(loaded.warnings) > MOST_TOLD
        what += f", but {f'more than {MOST_TOLD} warnings' if many else counted(len(warnings), 'warning')}"
    hint(f"{loaded.name}: {what}")
    sys.exit(1 if strict and warnings else 0)


@command.command("schema")
def schema() -> None:
    """Print the JSON Schema of sim/config.json, for completion in editors.

    Write it to sim/config.schema.json, and put "$schema": "config.schema.json" at the top of sim/config.json.

    \b
    Exit codes: 0 printed, 2 wrong usage.
    """
    from pyfrc_core.config.sim import sim_config_schema

    click.echo(sim_config_schema())


def _loaded(directory: Path | None) -> LoadedSimConfig:
    from pyfrc_core.config.sim_file import load_sim_config

    return load_sim_config(chosen_project(directory).root, shown_from=Path.cwd())
