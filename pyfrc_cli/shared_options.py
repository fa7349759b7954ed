"""Options that several commands have, so that each is described once."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, TypeVar

import click

from .file_options import WrittenFile

Function = TypeVar("Function", bound=Callable[..., Any])

#: What a trace is, in the help of the commands that write one.
TRACE = "every change of a device's value, as JSON lines, to compare two runs."

allow_host_option = click.option(
    "--allow-host",
    multiple=True,
    metavar="HOST",
    help="Also serve the page under this host name, to which a port of this computer is forwarded; may be repeated.",
)
builtin_option = click.option(
    "--builtin", is_flag=True, help="Also run the ready-made tests, unless the project imports them."
)
fail_under_option = click.option(
    "--fail-under",
    metavar="PERCENT",
    type=click.FloatRange(0, 100),
    help="Fail when less of the project is covered.",
)
port_option = click.option(
    "--port",
    type=click.IntRange(1, 65535),
    metavar="PORT",
    help="Serve the page at this port. Default: any free one.",
)
team_option = click.option("--team", type=int, metavar="N", help="Your team's number.")


def isolation_option(what: str, *more: str, note: str = "") -> Callable[[Function], Function]:
    """Return the option ``--isolation``.

    :param what: what runs in a process of its own
    :param more: further choices
    :param note: what they mean
    """
    return click.option(
        "--isolation",
        type=click.Choice(["auto", "fork", "reuse", *more]),
        help=f"The process in which each {what} runs. Default: auto, which chooses one of: fork, a copy of pyfrc's own "
        f"(Linux only); reuse, an earlier one, after a check that nothing of the robot before is left in it.{note}",
    )


def page_option(what: str, name: str, more: str = "") -> Callable[[Function], Function]:
    """Return the option ``--page``.

    :param what: what the page shows
    :param name: an example of a file
    """
    return click.option(
        "--page",
        type=WrittenFile(),
        metavar="FILE",
        help=f"Write {what} as a page, such as {name}, for any browser{more}.",
    )


def can_ask() -> bool:
    """Return whether the user can be asked."""
    return sys.stdin.isatty() and sys.stdout.isatty()


yes_option = click.option("-y", "--yes", is_flag=True, help="Do not ask.")
