"""`pyfrc deploy`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from pyfrc_core.processes.loading import loading

from .project_options import chosen_project, project_options
from .robot_options import errors_shown, json_option, nc_ds_option, project_if_any, robot_options, user_interface
from .shared_options import builtin_option
from .verbosity import verbosity

if TYPE_CHECKING:
    from pyfrc_core.deploy.team import RobotChoice


@click.command("deploy")
@project_options
@robot_options
@builtin_option
@click.option("--skip-tests", is_flag=True, help="Do not run the tests.")
@click.option("--large", is_flag=True, help="Also upload files over 250,000 bytes.")
@click.option(
    "--no-version-check",
    is_flag=True,
    help="Also deploy to a robot with another wpilib, Python or image, or without packages that the program needs.",
)
@click.option("--nonstandard", is_flag=True, help="Allow a main file with another name than robot.py.")
@click.option(
    "--debug", is_flag=True, help="Start the program so that its assert statements run, and with more log messages."
)
@click.option("--dry-run", is_flag=True, help="Only show what would be added, changed and removed.")
@click.option(
    "--auto-rollback",
    is_flag=True,
    help="Go back to the previous program if the new one ends during its start.",
)
@click.option(
    "--reinstall",
    is_flag=True,
    help="Compare the robot's packages with their hashes, send again what differs, and compile everything again.",
)
@click.option(
    "--rollback",
    metavar="[ID]",
    is_flag=False,
    flag_value="",
    help="Deploy nothing. Start an earlier release: the previous one, or the given one.",
)
@click.option("--nc", "--netconsole", "netconsole", is_flag=True, help="Then show the program's output.")
@nc_ds_option
@json_option
def command(
    directory: Path | None,
    main: Path | None,
    robot_class: str | None,
    choice: RobotChoice,
    builtin: bool,
    skip_tests: bool,
    large: bool,
    no_version_check: bool,
    nonstandard: bool,
    debug: bool,
    dry_run: bool,
    auto_rollback: bool,
    reinstall: bool,
    rollback: str | None,
    netconsole: bool,
    nc_ds: bool,
    as_json: bool,
) -> None:
    """Deploy the robot program and start it.

    Only changed files are sent. The old program keeps running until the new one is complete. If the deploy
    is interrupted, the robot still has a complete program.

    \b
    Exit codes: 0 deployed, and the program runs; 1 not deployed, the robot has its old program;
    2 wrong usage or no project; 130 Ctrl-C; 3 deployed, but the program ended during its start;
    4 deployed or possibly deployed, but not confirmed to run: the message explains the robot's state.
    """
    if (netconsole or nc_ds) and (as_json or dry_run):
        raise click.UsageError(f"--netconsole and {'--json' if as_json else '--dry-run'} are mutually exclusive.")
    if rollback is not None and (dry_run or auto_rollback):
        raise click.UsageError("--rollback excludes --dry-run and --auto-rollback: it deploys nothing.")
    if reinstall and (dry_run or rollback is not None):
        raise click.UsageError("--reinstall excludes --dry-run and --rollback.")
    if rollback and not rollback.isdecimal():
        raise click.UsageError(f"--rollback {rollback!r}: a release is a number; pyfrc deploy-info lists them.")
    with errors_shown(choice, as_json):
        with loading(verbosity().quiet):
            from pyfrc_core.deploy import session

        talk = user_interface(choice, as_json)
        if rollback is not None:
            release = int(rollback) if rollback else None
            project = project_if_any(directory, choice, main, robot_class)
            address = session.rollback(project, choice, release, talk)
        else:
            project = chosen_project(directory, main, robot_class)
            options = session.DeployOptions(
                choice=choice,
                builtin=builtin,
                skip_tests=skip_tests,
                large=large,
                check_versions=not no_version_check,
                nonstandard=nonstandard,
                debug=debug,
                dry_run=dry_run,
                auto_rollback=auto_rollback,
                reinstall=reinstall,
            )
            address = session.deploy(project, options, talk)
    if netconsole or nc_ds:
        from pyfrc_core.deploy.errors import DeployError

        try:
            session.show_console(project, choice, talk, nc_ds, address)
        except DeployError as error:  # exit code 1 would mean that the robot has its old program
            talk.progress.warning(str(error))
