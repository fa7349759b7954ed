"""The options of the commands that talk to a robot: which robot, how they tell of it, and what they ask."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .loudness import loudness

if TYPE_CHECKING:
    from pathlib import Path

    from pyfrc_core.deploy.progress import Conversation
    from pyfrc_core.deploy.reach import RobotChoice
    from pyfrc_core.project import Project

Function = TypeVar("Function", bound=Callable[..., Any])

json_option = click.option("--json", "as_json", is_flag=True, help="For tools: one JSON object a line. Asks nothing.")


def robot_options(command: Function) -> Function:
    """Adds ``--robot``, ``--team``, ``--no-resolve`` and ``--accept-host-key``, which become ``choice``."""

    @wraps(command)
    def with_choice(
        *, robot: str | None, team: int | None, no_resolve: bool, accept_host_key: str | None, **others: Any
    ) -> Any:
        if robot is not None and team is not None:
            raise click.UsageError("--robot and --team cannot both be.")
        from pyfrc_core.deploy.reach import RobotChoice

        choice = RobotChoice(robot=robot, team=team, resolve=not no_resolve, accepted_key=accept_host_key)
        return command(choice=choice, **others)

    wrapped: Any = with_choice
    for option in (
        click.option(
            "--accept-host-key",
            metavar="SHA256:...",
            help="Accept the robot's changed key, by the fingerprint that the refusal has shown.",
        ),
        click.option("--no-resolve", is_flag=True, help="Try addresses only: look no names up."),
        click.option("--team", type=int, metavar="N", help="Your team's number."),
        click.option("--robot", metavar="HOST[:PORT]", help="The robot's address, instead of your team's addresses."),
    ):
        wrapped = option(wrapped)
    return wrapped  # type: ignore[no-any-return]


def project_if_any(
    directory: Path | None, main: Path | None, robot_class: str | None, choice: RobotChoice
) -> Project | None:
    """The project; none where nothing names one, there is none here, and the options name the robot."""
    from pyfrc_core.errors import ProjectError
    from pyfrc_core.project import find_project

    try:
        return find_project(directory, main, robot_class)
    except ProjectError as error:
        if directory is not None or main is not None:
            raise
        if choice.names_robot:
            return None
        remedy = f"{error.remedy or ''}\n  Without a project, name the robot: --robot HOST or --team NUMBER."
        raise ProjectError(error.message, where=error.where, remedy=remedy.strip()) from error


def conversation(as_json: bool = False) -> Conversation:
    """How a command tells what it does, and asks; it asks nothing where there is no terminal."""
    from pyfrc_core.deploy.progress import Conversation, Questions, progress_for

    ask = None
    if not as_json and sys.stdin.isatty() and sys.stdout.isatty():
        ask = Questions(
            text=lambda question: str(click.prompt(question, prompt_suffix=" ")),
            yes=lambda question: click.confirm(question),
        )
    return Conversation(progress_for(as_json, loudness().quiet), ask)


@contextmanager
def told_as_json(as_json: bool) -> Iterator[None]:
    """Tells errors as JSON, too, where that is wanted."""
    from pyfrc_core.errors import PyfrcError, UsageError

    try:
        yield
    except (PyfrcError, OSError, KeyboardInterrupt) as error:
        if as_json:
            from pyfrc_core.deploy.progress import JsonProgress

            if isinstance(error, KeyboardInterrupt):
                told: PyfrcError = UsageError("interrupted")
            else:
                told = error if isinstance(error, PyfrcError) else PyfrcError(str(error))
            JsonProgress().failure(told)
        raise
