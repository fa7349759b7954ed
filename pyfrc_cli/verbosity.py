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
    """Add `-v`, `-q` and `-h` to a command that does not have them."""
    if QUIET not in command.params:
        command.context_settings.setdefault("help_option_names", HELP)
        command.params += [_verbose(_ALSO.get(command.name or "", "")), QUIET]


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


def _verbose(also: str) -> click.Option:
    return _option("v", "verbose", f"Show the whole traceback of an error, instead of one sentence{also}.")


#: What `-v` does in some commands besides.
_ALSO = {
    "test": "; print the name of each test",
    "sim": "; with --log, print each value that differs",
    "sync": "; print where each file is from",
    "coverage": ", and what -v shows in the other command",
    "profile": ", and what -v shows in the other command",
}
HELP = ["-h", "--help"]
VERBOSE = _verbose("; some commands print more, too: see their -h")
QUIET = _option("q", "quiet", "Print only results, warnings and errors.")
