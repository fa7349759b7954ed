"""Progress output of a deploy: on a terminal, as plain lines, or as JSON lines for tools.

A message may suggest ``pyfrc deploy --rollback``. Without ``--robot HOST``, this command would use the team's robot,
which may be another one. So the option is added here, in one place, to all messages of a command.
"""

from __future__ import annotations

import json
import os
import re
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from ..errors import PyfrcError
from ..shell import quoted
from ..terminal_text import escape_unencodable, visible
from .errors import RefusedError

_NAME_WIDTH = 10
_DETAIL_WIDTH = 58

#: Descriptions of the agent's phases.
_WORK = {
    "check": "checking {} files",
    "hash": "comparing",
    "link": "linking {} files",
    "copy": "copying {} files",
    "compile": "compiling {} files",
    "sync": "waiting for the robot's disk",
    "carry": "searching {} files for files that the program wrote",
    "switch": "switching",
    "remove": "removing old files",
    "stop": "waiting for the old program to end",
}


def describe_work(what: str, done: int, total: int) -> str:
    """Return a description of the robot's work, such as ``checking 2,300 of 5,000 files``."""
    number = f"{done:,} of {total:,}" if done <= total else f"{done:,}"
    return _WORK.get(what, "working").format(number)


@dataclass(frozen=True)
class Questions:
    """Functions that ask the user: `text` for a text, `yes` for yes or no."""

    text: Callable[[str], str]
    yes: Callable[[str], bool]


class Phase:
    """One step of a deploy in progress."""

    def __init__(self, name: str) -> None:
        self.name = name
        #: The result, for the step's line of output.
        self.detail = ""

    def bytes(self, done: int, total: int) -> None:
        """Show how many bytes of this phase are done, if the output can show this."""

    def doing(self, text: str) -> None:
        """Show the current activity, if the output can show this."""

    def work(self, what: str, done: int, total: int) -> None:
        """Show the robot's progress in this phase.

        :param what:  the agent's name for its work
        :param done:  completed files, or bytes of file contents
        :param total: 0 if unknown
        """
        if what in ("send", "receive"):
            self.bytes(done, total)
        else:
            self.doing(describe_work(what, done, total))


class DeployProgress:
    """Progress as plain lines, one for each completed phase.

    :param quiet: print only requested information, warnings and errors
    """

    def __init__(self, stream: IO[str] | None = None, quiet: bool = False) -> None:
        self._stream = stream or sys.stdout
        self.quiet = quiet
        #: Adds the robot's options to commands in notes and warnings.
        self.add_robot_option: Callable[[str], str] = str

    @property
    def child_output(self) -> IO[str]:
        """The stream for the output of child processes."""
        return self._stream

    @contextmanager
    def phase(self, name: str, own_output: bool = False) -> Iterator[Phase]:
        """Run a phase, and print its result and duration at its end.

        :param own_output: whether a child process prints to the terminal meanwhile
        """
        began = time.monotonic()
        with self._shown(Phase(name), own_output) as phase:
            yield phase
        if not self.quiet:
            self._over(phase, time.monotonic() - began)

    def note(self, text: str) -> None:
        """Print a note."""
        if not self.quiet:
            self._note(self.add_robot_option(text))

    def warning(self, text: str) -> None:
        """Print a warning."""
        self._print(f"warning: {self.add_robot_option(text)}")

    def output(self, text: str) -> None:
        """Print output of the robot program."""
        self._print("".join(f"  | {line}\n" for line in text.splitlines()).rstrip("\n"))

    def result(self, result: Mapping[str, object], text: str, requested: bool = False) -> None:
        """Print the result of the command.

        :param result: for JSON
        :param text: for people
        :param requested: whether the command exists to show this information
        """
        if requested or not self.quiet:
            self._print(text)

    def _note(self, text: str) -> None:
        self._print(text)

    @contextmanager
    def _shown(self, phase: Phase, own_output: bool) -> Iterator[Phase]:
        yield phase

    def _over(self, phase: Phase, seconds: float) -> None:
        self._print(f"{phase.name:<{_NAME_WIDTH}} {phase.detail:<{_DETAIL_WIDTH}} {seconds:6.2f} s")

    def _print(self, text: str) -> None:
        self._write(visible(text))

    def _write(self, text: str) -> None:
        try:
            print(text, file=self._stream, flush=True)
        except BrokenPipeError:
            # The reader has ended, as with `| head`. The work on the robot continues.
            with Path(os.devnull).open("wb") as null:
                os.dup2(null.fileno(), self._stream.fileno())


class TerminalProgress(DeployProgress):
    """Plain lines, and the current activity with a progress bar for bytes."""

    @contextmanager
    def _shown(self, phase: Phase, own_output: bool) -> Iterator[Phase]:
        if own_output:
            yield phase
            return
        from rich.console import Console
        from rich.progress import BarColumn, DownloadColumn, SpinnerColumn, TextColumn
        from rich.progress import Progress as Bars

        console = Console(file=self._stream)
        spinning = [SpinnerColumn(), TextColumn("{task.description}")]
        with Bars(*spinning, console=console, transient=True) as spinner:
            waiting = spinner.add_task(phase.name)
            bars = Bars(*spinning, BarColumn(), DownloadColumn(), console=console, transient=True)
            task = bars.add_task(phase.name, total=None)

            def change(old: Bars, new: Bars) -> None:
                if not new.live.is_started:
                    old.stop()
                    new.start()

            def show_bytes(done: int, total: int) -> None:
                change(spinner, bars)
                bars.update(task, completed=done, total=total)

            def show_text(text: str) -> None:
                change(bars, spinner)
                spinner.update(waiting, description=f"{phase.name}  {text}")

            phase.bytes = show_bytes  # type: ignore[method-assign]
            phase.doing = show_text  # type: ignore[method-assign]
            try:
                yield phase
            finally:
                bars.stop()


class JsonProgress(DeployProgress):
    """Progress as one JSON object per line. The last one is the result or the error."""

    @property
    def child_output(self) -> IO[str]:
        return sys.stderr

    def warning(self, text: str) -> None:
        self._event("warning", text=self.add_robot_option(text))

    def output(self, text: str) -> None:
        self._event("output", text=text)

    def result(self, result: Mapping[str, object], text: str, requested: bool = False) -> None:
        self._event("result", **result)

    def failure(self, error: PyfrcError) -> None:
        """Print an error."""
        self._event(
            "error",
            kind=type(error).__name__.removesuffix("Error"),
            message=error.message,
            where=error.where,
            remedy=error.remedy,
            exit_code=error.exit_code,
        )

    def _note(self, text: str) -> None:
        self._event("note", text=text)

    def _over(self, phase: Phase, seconds: float) -> None:
        self._event("phase", phase=phase.name, detail=phase.detail, seconds=round(seconds, 3))

    def _event(self, event: str, **fields: object) -> None:
        self._write(json.dumps({"event": event, **fields}))


@dataclass(frozen=True)
class UserInterface:
    """Output to the user, and questions; `ask` is None if the user cannot be asked."""

    progress: DeployProgress
    ask: Questions | None = None


def ask_to_continue(failure: str, ask: Questions | None, remedy: str, error: PyfrcError | None = None) -> None:
    """Ask the user whether to deploy in spite of a failure.

    :param ask: None if the user cannot be asked
    :raises RefusedError: if the user says no or cannot be asked
    """
    if ask is None:
        raise RefusedError(f"not deployed: {failure}", remedy=remedy) from error
    if not ask.yes(f"{failure[:1].upper()}{failure[1:]}. Deploy anyway?"):
        raise RefusedError(f"not deployed: {failure}") from error


def progress_for(as_json: bool, quiet: bool = False) -> DeployProgress:
    """Return the progress output for standard output, which then escapes characters that it cannot encode."""
    escape_unencodable(sys.stdout)
    if as_json:
        return JsonProgress(quiet=quiet)
    return TerminalProgress() if sys.stdout.isatty() and not quiet else DeployProgress(quiet=quiet)


#: A command about a robot without an option that selects the robot.
_COMMAND = re.compile(r"\bpyfrc (?:deploy-info|deploy|undeploy|console|doctor|logs)\b(?!-)(?! --(?:robot|team)\b)")


def with_robot_option(text: str, robot: str | None, team: int | None) -> str:
    """Return a message with the robot's option added to each command line in it.

    :param text: the message, with commands such as ``pyfrc deploy --rollback``
    :param robot: the address from the command line, as ``HOST`` or ``HOST:PORT``
    :param team: the team number from the command line; without both, the text stays unchanged
    """
    if robot is not None:
        options = f"--robot {quoted(robot)}"
    elif team is not None:
        options = f"--team {team}"
    else:
        return text
    return _COMMAND.sub(lambda found: f"{found[0]} {options}", text)
