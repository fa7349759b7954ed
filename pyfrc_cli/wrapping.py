"""Commands that measure another command: `pyfrc coverage test`, `pyfrc profile replay script.jsonl`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from .main import loaded, refuse_repeated_options
from .project_options import chosen_project

if TYPE_CHECKING:
    from pyfrc_core.project import Project

#: The commands that can be measured.
WRAPPABLE = ("test", "sim", "fuzz", "replay")
#: Settings of the wrapping command: arguments after the wrapped command's name belong to that one.
WRAPPING: dict[str, Any] = {"allow_interspersed_args": False}


@dataclass(frozen=True)
class Wrapped:
    """A command with its options, ready to run.

    :param name: its name
    :param project: its robot project
    """

    name: str
    project: Project
    _context: click.Context

    def run(self) -> int:
        """Run it; return its exit code."""
        try:
            with self._context:
                self._context.command.invoke(self._context)
        except SystemExit as ended:
            return ended.code if isinstance(ended.code, int) else int(ended.code is not None)
        except click.exceptions.Exit as ended:
            return ended.exit_code
        except (KeyboardInterrupt, click.Abort):
            click.secho("interrupted", err=True)  # the measurements until now are still reported
            return 2
        return 0


def wrapped_command(context: click.Context, words: Sequence[str]) -> Wrapped:
    """Parse the words as a command.

    :param context: the context of the wrapping command
    :param words: the wrapped command's name and arguments
    :raises click.UsageError: when it is not one of them, or its options are wrong
    """
    name, *arguments = words
    if name not in WRAPPABLE:
        raise click.UsageError(
            f"{name!r} is not a command that can be measured. These can: {', '.join(WRAPPABLE)}.", context
        )
    command = loaded(name)
    refuse_repeated_options(command, name, arguments, context)
    inner = command.make_context(name, arguments, parent=context)
    options = inner.params
    with inner.scope(cleanup=False):
        project = chosen_project(options["directory"], options["main"], options["robot_class"])
    return Wrapped(name, project, inner)
