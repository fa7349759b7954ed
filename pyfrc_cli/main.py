"""The command line: a group of commands, each imported only when it is used."""

from __future__ import annotations

import difflib
import importlib
import os
import re
import sys
import traceback
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import click

from pyfrc_core._version import __version__
from pyfrc_core.errors import PyfrcError

from .verbosity import HELP, QUIET, VERBOSE, Verbosity, add_options

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

#: Each command's module and help text, listed here so that the help imports none of them.
COMMANDS = {
    "init": ("pyfrc_cli.init", "Create a new robot project from a template."),
    "fuzz": ("pyfrc_cli.fuzz", "Play matches with random inputs, and save the shortest script of each failure."),
    "replay": ("pyfrc_cli.replay", "Run the robot with the inputs of a recorded script."),
    "sim": ("pyfrc_cli.sim", "Simulate the robot, on a page in your browser, and drive it there."),
    "view": ("pyfrc_cli.view", "Look at logs of a robot, or at a robot, live: values, plots, field, console."),
    "test": ("pyfrc_cli.test", "Run the robot project's tests."),
    "coverage": ("pyfrc_cli.coverage", "Measure which lines of the robot run in another command."),
    "profile": ("pyfrc_cli.profile", "Measure how long the robot's functions take in another command."),
    "add-tests": ("pyfrc_cli.add_tests", "Add the ready-made tests to the robot project."),
    "create-physics": ("pyfrc_cli.create_physics", "Write a physics.py and sim/config.json that fit the robot."),
    "sync": ("pyfrc_cli.sync", "Download what the robot needs: its Python, and the project's packages."),
    "deploy": ("pyfrc_cli.deploy", "Deploy the robot program, and start it."),
    "deploy-info": ("pyfrc_cli.deploy_info", "Show the program on the robot and its earlier releases."),
    "undeploy": ("pyfrc_cli.undeploy", "Stop the robot program and remove it from the robot."),
    "console": ("pyfrc_cli.console", "Show the robot program's output."),
    "logs": ("pyfrc_cli.logs", "List the logs on the robot, and fetch them."),
    "virtual-robot": ("pyfrc_cli.virtual_robot", "Start a virtual robot on this computer, to deploy to."),
    "config": ("pyfrc_cli.config", "Check sim/config.json, and print its JSON Schema."),
    "migrate": ("pyfrc_cli.migrate", "Rewrite a robot project of 2026 for WPILib 2027."),
    "doctor": ("pyfrc_cli.doctor", "Find missing packages, wrong settings and connection problems."),
}

#: Names that commands have had before. They work, and neither the help nor a shell's completion lists them.
OLDER_NAMES = {"profiler": "profile", "create-tests": "add-tests"}

#: Names that other tools have for what pyfrc, or another tool, does; ``{robotpy}`` is how to install the season's.
OTHER_NAMES = {
    "run": "To run the robot on this computer: pyfrc sim. To start it on the robot: pyfrc deploy",
    "installer": "To install packages on the robot: {robotpy}, then: python -m robotpy installer",
    "download": "To download what the robot needs: pyfrc sync",
    "rollback": "To go back to an earlier release: pyfrc deploy --rollback",
    "netconsole": "To see the robot program's output: pyfrc console",
    "log": "To look at a log: pyfrc view FILE. To fetch logs from the robot: pyfrc logs",
    "create": "To create a project: pyfrc init",
    "new": "To create a project: pyfrc init",
    "simulate": "To simulate the robot: pyfrc sim",
    "check": "To find problems of the project: pyfrc doctor",
}


class Commands(click.Group):
    """The group of all commands; each is imported when it is used."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        name = OLDER_NAMES.get(name, name)
        return loaded(name) if name in COMMANDS else None

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        if args and args[0] not in COMMANDS.keys() | OLDER_NAMES and not args[0].startswith("-"):
            close = difflib.get_close_matches(args[0], COMMANDS, n=1)
            hint = f" Did you mean {close[0]!r}?" if close else ""
            if args[0] in OTHER_NAMES:
                from pyfrc_core.config.packages import install_line

                hint = f" {OTHER_NAMES[args[0]].format(robotpy=install_line('robotpy'))}"
            from pyfrc_core.log_formats import LOGS

            if args[0].lower().endswith(LOGS):
                hint = " To look at a log: pyfrc view FILE"
            if args[0].endswith(".py"):
                hint = " pyfrc finds the robot's file by itself, for example: pyfrc sim"
            raise click.UsageError(f"There is no command {args[0]!r}.{hint}", ctx)
        name, command, rest = super().resolve_command(ctx, args)
        if command is not None and not ctx.resilient_parsing:
            refuse_repeated_options(command, name, rest, ctx)
        return name, command, rest

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command. Where its output is no longer read, as by ``head -1``, its exit code is that of SIGPIPE.

        click ends with 1 then, which means a failed test, and without a word, also for other broken connections.
        """
        try:
            return super().invoke(ctx)
        except BrokenPipeError as error:
            try:
                print(flush=True)
            except OSError:
                with suppress(OSError):  # as with 2>&1
                    click.secho("interrupted: the output is no longer read", err=True)
                os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # for what is printed at the end
                sys.exit(128 + 13)
            raise PyfrcError(f"a connection has ended: {error}") from error

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        from click.shell_completion import CompletionItem

        names = [CompletionItem(name, help=text) for name, (_, text) in COMMANDS.items() if name.startswith(incomplete)]
        return [*names, *click.Command.shell_complete(self, ctx, incomplete)]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in COMMANDS.items()])


def refuse_repeated_options(command: click.Command, name: str | None, words: list[str], parent: click.Context) -> None:
    """Refuse an option with one value that is given twice, of which click would take the last one silently.

    :param words: those after the command's name
    :raises UsageError: naming it
    """
    context = click.Context(command, parent, name, **command.context_settings)
    _, _, given = command.make_parser(context).parse_args(list(words))
    options = (each for each in given if isinstance(each, click.Option))
    once = [each for each in options if not (each.multiple or each.is_flag or each.count)]
    for number, option in enumerate(once):
        if option in once[:number]:
            raise click.UsageError(f"{max(option.opts, key=len)} is given twice: give it once.", context)


def loaded(name: str) -> click.Command:
    """Import and return a command."""
    command: click.Command = importlib.import_module(COMMANDS[name][0]).command
    group = command.commands.values() if isinstance(command, click.Group) else ()
    for each in (command, *group):
        add_options(each)
    return command


@click.command(cls=Commands, context_settings={"help_option_names": HELP}, params=[VERBOSE, QUIET])
@click.version_option(__version__, prog_name="pyfrc")
def cli() -> None:
    """Write, test and run FIRST Robotics Competition robot code in Python."""


def run() -> None:
    """Run the command line. An error that pyfrc knows is shown as one sentence, with exit code 1 or 2."""
    from pyfrc_core.terminal_text import escape_unencodable, visible

    for stream in (sys.stdout, sys.stderr):
        escape_unencodable(stream)
    chosen = Verbosity()
    # None: colors only on a terminal.
    color = False if os.environ.get("NO_COLOR") else None
    try:
        sys.exit(cli.main(prog_name="pyfrc", standalone_mode=False, color=color, obj=chosen))
    except (click.exceptions.Abort, ImportError) as error:
        # A library in C++ that is being imported reports Ctrl-C as a failed import.
        if isinstance(error, ImportError) and not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        click.secho("interrupted", err=True)
        sys.exit(2)
    except click.ClickException as error:
        if isinstance(error, click.NoSuchOption):
            nearest = difflib.get_close_matches(error.option_name, error.possibilities or (), n=1, cutoff=0.7)
            error = click.NoSuchOption(error.option_name, possibilities=nearest, ctx=error.ctx)
        error.show()
        if remedy := _remedy(error):
            click.echo(remedy, err=True)
        sys.exit(error.exit_code)
    except (PyfrcError, OSError) as error:
        if chosen.verbose:
            click.echo(visible(traceback.format_exc()), err=True, nl=False)
        else:
            click.secho(f"error: {visible(_message(error))}", fg="red", err=True, color=color)
        sys.exit(getattr(error, "exit_code", 1))


def _remedy(error: click.ClickException) -> str:
    """Return advice for users who are used to another tool."""
    if not isinstance(error, click.UsageError) or error.ctx is None:
        return ""
    command = error.ctx.info_name
    if isinstance(error, click.NoSuchOption) and command == "test":
        return "Write options of pytest after --, for example: pyfrc test -- -k drive"
    if isinstance(error, click.NoSuchOption) and command == "sim" and error.option_name == "--headless":
        return "Write: pyfrc sim --ui none, or with an end: pyfrc sim --ui none --mode practice"
    if isinstance(error, click.NoSuchOption) and command == "sim" and "gui" in error.option_name:
        return "Write: pyfrc sim, for the simulator's page, or: pyfrc sim --ui none --mode practice"
    if isinstance(error, click.NoSuchOption) and command == "view" and error.option_name == "--log":
        return "To look at a log: pyfrc view FILE. To run your code with its inputs: pyfrc sim --log FILE"
    if command == "sim" and (extra := re.search(r"unexpected extra argument \((.*)\)", error.message, re.DOTALL)):
        if os.path.isdir(extra[1]):  # noqa: PTH112 - a name that is too long is none
            return f"To simulate the project in it: pyfrc sim --project {extra[1]}"
        if not extra[1].endswith(".py") and os.path.isfile(extra[1]):  # noqa: PTH113
            return f"To run your code with the inputs of a log: pyfrc sim --log {extra[1]}"
    if re.search(r"unexpected extra arguments? \(.*\.py\b", error.message):
        takes_main = any("--main" in parameter.opts for parameter in error.ctx.command.params)
        return "pyfrc finds the robot's file." + " Use --main FILE if it is not called robot.py." * takes_main
    if command in ("deploy", "deploy-info", "undeploy", "console"):
        extra = re.search(r"unexpected extra argument \((\S+)\)", error.message)
        if extra is not None and (extra[1].isdecimal() or re.search(r"[.:]|^roborio", extra[1], re.IGNORECASE)):
            return f"Write: pyfrc {command} {'--team' if extra[1].isdecimal() else '--robot'} {extra[1]}"
    return ""


def _message(error: Exception) -> str:
    """Return the message; for an error of the operating system the file and the reason, without the error number."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror if error.filename is None else f"{error.filename}: {error.strerror}"
    return str(error)
