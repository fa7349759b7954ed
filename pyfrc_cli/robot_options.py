"""Options of the commands that connect to a robot, and their output, questions and errors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cache, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .shared_options import can_ask, team_option
from .verbosity import verbosity

if TYPE_CHECKING:
    from pyfrc_core.deploy.progress import UserInterface
    from pyfrc_core.deploy.team import RobotChoice
    from pyfrc_core.project import Project

Function = TypeVar("Function", bound=Callable[..., Any])

json_option = click.option("--json", "as_json", is_flag=True, help="For tools: one JSON object per line. Asks nothing.")


def refuse_option_as_value(context: click.Context, option: click.Parameter, value: object) -> Any:
    """Check that the value of an option is not the next option, as in ``--robot --skip-tests``.

    :raises click.BadParameter: if it begins with a dash
    """
    if value is not None and str(value).startswith("-"):
        raise click.BadParameter(f"{str(value)!r} begins with '-': the value is missing.", context, option)
    return value


def robot_options(command: Function) -> Function:
    """Add the options for logging in to a robot (address and keys), which become ``choice``."""

    @wraps(command)
    def with_keys(
        *,
        choice: RobotChoice,
        accept_host_key: str | None,
        robot_name: str | None,
        **others: object,
    ) -> Any:
        from pyfrc_core.deploy.login import Credentials

        choice = replace(
            choice,
            accepted_key=accept_host_key,
            robot_name=robot_name,
            credentials=Credentials(_password_prompt(bool(others.get("as_json")))),
        )
        return command(choice=choice, **others)

    return address_options(_with_options(with_keys, _KEY_OPTIONS))  # type: ignore[no-any-return]


def _password_prompt(as_json: bool) -> Callable[[str], str] | None:
    """Return a function that asks for a robot's password; each robot's once. It is kept nowhere else."""
    if as_json or not can_ask():
        return None

    @cache
    def ask(robot: str) -> str:
        return str(click.prompt(f"Password of {robot}", hide_input=True))

    return ask


def address_options(command: Function) -> Function:
    """Add the options for a robot's address, which become ``choice``."""

    @wraps(command)
    def with_address(*, robot: str | None, team: int | None, no_resolve: bool, **others: object) -> Any:
        if robot is not None and team is not None:
            raise click.UsageError("--robot and --team are mutually exclusive.")
        from pyfrc_core.deploy.team import RobotChoice

        return command(choice=RobotChoice(robot=robot, team=team, resolve=not no_resolve), **others)

    return _with_options(with_address, _ADDRESS_OPTIONS)  # type: ignore[no-any-return]


_KEY_OPTIONS = (
    click.option(
        "--robot-name",
        metavar="NAME",
        callback=refuse_option_as_value,
        help="Store this name with the robot's key, and show it.",
    ),
    click.option(
        "--accept-host-key",
        metavar="SHA256:...",
        callback=refuse_option_as_value,
        help="Accept the robot's changed key. The error message shows its fingerprint.",
    ),
)
robot_option = click.option(
    "--robot",
    metavar="HOST[:PORT]",
    callback=refuse_option_as_value,
    help="The robot's address, instead of your team's addresses.",
)
nc_ds_option = click.option(
    "--nc-ds",
    "--netconsole-ds",
    "nc_ds",
    is_flag=True,
    help="Show the program's output even if no Driver Station is connected to the robot.",
)
_ADDRESS_OPTIONS = (
    click.option(
        "--no-resolve",
        is_flag=True,
        help="Try only addresses such as 10.12.34.2, no names such as roboRIO-1234-FRC.local.",
    ),
    team_option,
    robot_option,
)


def _with_options(command: Any, options: Iterable[Callable[[Any], Any]]) -> Any:
    for option in options:
        command = option(command)
    return command


def project_if_any(
    directory: Path | None, choice: RobotChoice, main: Path | None = None, robot_class: str | None = None
) -> Project | None:
    """Return the project, or None outside of a project if the options specify the robot.

    :raises ProjectError: if there is no project otherwise
    """
    from pyfrc_core.errors import ProjectError
    from pyfrc_core.project import find_project

    try:
        return find_project(directory, main, robot_class)
    except ProjectError as error:
        if directory is not None or main is not None:
            raise
        if choice.names_robot:
            return None
        remedy = f"{error.remedy or ''}\n  Without a project, specify the robot: --robot HOST or --team NUMBER."
        raise ProjectError(error.message, where=error.where, remedy=remedy.strip()) from error


def user_interface(choice: RobotChoice, as_json: bool = False) -> UserInterface:
    """Return the output and the questions of a command. Without a terminal, it cannot ask."""
    from pyfrc_core.deploy.progress import Questions, UserInterface, progress_for, with_robot_option

    ask = None
    if not as_json and can_ask():
        ask = Questions(
            text=lambda question: str(click.prompt(question, prompt_suffix=" ")),
            yes=lambda question: click.confirm(question),
        )
    progress = progress_for(as_json, verbosity().quiet)
    progress.add_robot_option = lambda text: with_robot_option(text, choice.robot, choice.team)
    return UserInterface(progress, ask)


@contextmanager
def errors_shown(choice: RobotChoice, as_json: bool = False) -> Iterator[None]:
    """Add the robot's option to commands in error messages. Also print errors as JSON if requested."""
    from pyfrc_core.errors import PyfrcError, UsageError
    from pyfrc_core.interruption import interruption

    try:
        yield
    except (PyfrcError, OSError, KeyboardInterrupt) as error:
        if isinstance(error, PyfrcError) and error.remedy is not None:
            from pyfrc_core.deploy.progress import with_robot_option

            error.remedy = with_robot_option(error.remedy, choice.robot, choice.team)
        if as_json:
            from pyfrc_core.deploy.progress import JsonProgress

            if isinstance(error, KeyboardInterrupt):
                shown: PyfrcError = UsageError("interrupted")
            else:
                shown = error if isinstance(error, PyfrcError) else PyfrcError(str(error))
            shown.exit_code = interruption.exit_code(shown.exit_code)
            JsonProgress().failure(shown)
        raise
