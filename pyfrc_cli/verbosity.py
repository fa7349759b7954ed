"""The options `-v` and `-q`, which have the same meaning before and after a command's name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import click


@dataclass
class Verbosity:
    """How much to print.

    :param verbose: also print the traceback of an error
    :param quiet: print only results, warnings and errors
    """

    verbose: bool = False
    quiet: bool = False


def verbosity() -> Verbosity:
    """Return the verbosity of the command that is running."""
    return _of(click.get_current_context())


def hint(text: str, **style: Any) -> None:
    """Print progress or advice, unless the user wants it quiet."""
    if not verbosity().quiet:
        click.secho(text, **style)


def add_options(command: click.Command) -> None:
    """Add `-v` and `-q` to a command that does not have them."""
    if QUIET not in command.params:
        command.params += [VERBOSE, QUIET]


def _of(context: click.Context) -> Verbosity:
    found: Verbosity = context.ensure_object(Verbosity)
    return found


def _choose(context: click.Context, option: click.Parameter, chosen: bool) -> None:
    if not chosen or context.resilient_parsing:
        return
    chosen_verbosity = _of(context)
    setattr(chosen_verbosity, str(option.name), True)
    if chosen_verbosity.verbose and chosen_verbosity.quiet:
        raise click.UsageError("--verbose and --quiet are mutually exclusive.", context)


def _option(letter: str, name: str, help_text: str) -> click.Option:
    # Eager, for options that act while the command line is parsed, such as --list.
    return click.Option(
        [f"-{letter}", f"--{name}"], is_flag=True, is_eager=True, expose_value=False, callback=_choose, help=help_text
    )


VERBOSE = _option("v", "verbose", "Show the traceback of errors; name each test, and each difference from a log.")
QUIET = _option("q", "quiet", "Print only results, warnings and errors.")
