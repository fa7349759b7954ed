"""How a deploy is told while it goes on: to a person at a terminal, in plain lines, or as JSON lines for tools."""

from __future__ import annotations

import io
import json
import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from ..terminal_text import visible

if TYPE_CHECKING:
    from ..errors import PyfrcError

_NAME_WIDTH = 10
_DETAIL_WIDTH = 58

#: The agent's words for its work, in a terminal's.
_WORK = {
    "check": "checking {} files",
    "link": "linking {} files",
    "copy": "copying {} files",
    "compile": "compiling {} files",
    "sync": "waiting for the robot's disk",
    "carry": "looking through {} files for what the program has written",
    "switch": "switching",
    "remove": "removing old files",
    "stop": "waiting for the old program to end",
}


def wording_of_work(what: str, done: int, total: int) -> str:
    """What the robot does, as in ``checking 2,300 of 5,000 files``."""
    number = f"{done:,} of {total:,}" if done <= total else f"{done:,}"
    return _WORK.get(what, "working").format(number)


@dataclass(frozen=True)
class Questions:
    """How the user can be asked: for a text, and whether."""

    text: Callable[[str], str]
    yes: Callable[[str], bool]


class Phase:
    """One step of a deploy, while it goes on."""

    def __init__(self, name: str) -> None:
        self.name = name
        #: What came of it, for its line.
        self.detail = ""

    def bytes(self, done: int, total: int) -> None:
        """So many bytes of the phase's are done."""

    def doing(self, text: str) -> None:
        """Show what it does at the moment, where that can be shown."""

    def work(self, what: str, done: int, total: int) -> None:
        """Show what the robot does in this phase, and how far it is.

        :param what:  the agent's word for it
        :param done:  files, or bytes of what is received
        :param total: 0 where it is not known
        """
        if what in ("send", "receive"):
            self.bytes(done, total)
        else:
            self.doing(wording_of_work(what, done, total))


class Progress:
    """Plain lines: one for each phase, when it is over.

    :param quiet: tell only what was asked for, and what is wrong
    """

    def __init__(self, stream: IO[str] | None = None, quiet: bool = False) -> None:
        self._stream = stream or sys.stdout
        self.quiet = quiet
        #: Names the robot in the commands that a note or a warning suggests.
        self.name_robot: Callable[[str], str] = str

    @property
    def child_output(self) -> IO[str]:
        """Where the output of programs that a phase runs may go."""
        return self._stream

    @contextmanager
    def phase(self, name: str, own_output: bool = False) -> Iterator[Phase]:
        """A phase, told with its time when it is over.

        :param own_output: whether something prints on the terminal meanwhile
        """
        began = time.monotonic()
        with self._shown(Phase(name), own_output) as phase:
            yield phase
        if not self.quiet:
            self._over(phase, time.monotonic() - began)

    def note(self, text: str) -> None:
        """Something to know."""
        if not self.quiet:
            self._note(self.name_robot(text))

    def warning(self, text: str) -> None:
        """Something that may be wrong, but hinders nothing."""
        self._print(f"warning: {self.name_robot(text)}")

    def output(self, text: str) -> None:
        """What the robot program printed."""
        self._print("".join(f"  | {line}\n" for line in text.splitlines()).rstrip("\n"))

    def result(self, result: Mapping[str, Any], text: str, asked_for: bool = False) -> None:
        """What came of it all.

        :param asked_for: whether it is to know this that the command was called
        """
        if asked_for or not self.quiet:
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
            # Nobody listens any more, as after `| head`: what is done to the robot is brought to its end all the same.
            with Path(os.devnull).open("wb") as nowhere:
                os.dup2(nowhere.fileno(), self._stream.fileno())


class TerminalProgress(Progress):
    """The same lines, and meanwhile what is being done, with a bar for bytes."""

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


class JsonProgress(Progress):
    """One JSON object a line; the last is the result, or the error."""

    @property
    def child_output(self) -> IO[str]:
        return sys.stderr

    def warning(self, text: str) -> None:
        self._event("warning", text=self.name_robot(text))

    def output(self, text: str) -> None:
        self._event("output", text=text)

    def result(self, result: Mapping[str, Any], text: str, asked_for: bool = False) -> None:
        self._event("result", **result)

    def failure(self, error: PyfrcError) -> None:
        """What went wrong."""
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

    def _event(self, event: str, **fields: Any) -> None:
        # The one control character that JSON leaves as it is.
        self._write(json.dumps({"event": event, **fields}).replace("\x7f", "\\u007f"))


@dataclass(frozen=True)
class Conversation:
    """With the user: how is told, and how is asked; not at all where there is nobody to ask."""

    progress: Progress
    ask: Questions | None = None


def progress_for(as_json: bool, quiet: bool = False) -> Progress:
    """What suits where the output goes, which may not have all the letters of the robot's."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    if as_json:
        return JsonProgress(quiet=quiet)
    return TerminalProgress() if sys.stdout.isatty() and not quiet else Progress(quiet=quiet)
