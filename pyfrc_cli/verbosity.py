"""How much commands tell: `-v` and `-q`, which mean the same before a command's name and behind it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import click


@dataclass
class Verbosity:
    """What the user has said about it.

    :param verbose: the traceback of an error is told, too
    :param quiet:   what was asked for, warnings and errors are told, nothing else
    """

    verbose: bool = False
    quiet: bool = False


def verbosity() -> Verbosity:
    """That of the command which is running."""
    return _of(click.get_current_context())


def hint(text: str, **style: Any) -> None:
    """Print what somebody who wants it quiet does not want to know: progress, what to do next, praise."""
    if not verbosity().quiet:
        click.secho(text, **style)


def add_options(command: click.Command) -> None:
    """Give a command `-v` and `-q`, once."""
    if QUIET not in command.params:
        command.params += [VERBOSE, QUIET]


def _of(context: click.Context) -> Verbosity:
    found: Verbosity = context.ensure_object(Verbosity)
    return found


def _choose(context: click.Context, option: click.Parameter, chosen: bool) -> None:
    if not chosen or context.resilient_parsing:
        return
    said = _of(context)
    setattr(said, str(option.name), True)
    if said.verbose and said.quiet:
        raise click.UsageError("--verbose and --quiet cannot both be.", context)


def _option(letter: str, name: str, help_text: str) -> click.Option:
    # Eager, for options that are answered while the line is read, such as --list.
    return click.Option(
        [f"-{letter}", f"--{name}"], is_flag=True, is_eager=True, expose_value=False, callback=_choose, help=help_text
    )


VERBOSE = _option("v", "verbose", "Show the traceback of errors; with test, name each test.")
QUIET = _option("q", "quiet", "Print only what was asked for, warnings and errors.")
