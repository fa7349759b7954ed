"""Opens a log, whatever it is, or says in one sentence why not."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from ...errors import PyfrcError
from ..engine.past_run import PastRun
from . import recordings
from .columns import ReadLog
from .ds_log import is_ds_log, read_ds_events, read_ds_log
from .layout import run_of, when_of
from .wpilog import is_wpilog, read_wpilog

#: Endings of logs that only their makers' tools can read, with what converts them.
_FOREIGN = {
    ".hoot": "CTRE's format is closed. Phoenix Tuner X (Log Extractor) or CTRE's command owlet writes it as a "
    ".wpilog: owlet -f wpilog FILE.hoot FILE.wpilog",
    ".rlog": "This is AdvantageKit's format before 2023. AdvantageScope opens it, and exports it as a .wpilog.",
    ".revlog": "REV's format is not read here. AdvantageScope opens it, and exports it as a .wpilog.",
}
_SUFFIXES, _MOST_NAMED = (".wpilog", ".dslog", ".dsevents"), 5
#: How much of a file tells what it is.
_HEAD = 4096
_KINDS = "Logs are .wpilog, .dslog and .dsevents, and recordings and traces of pyfrc (.jsonl)."
#: The error of a file that is none.
NO_LOG = "this is not a log that pyfrc knows"


class LogError(PyfrcError):
    """A file cannot be shown as a log."""


@dataclass(frozen=True)
class OpenedLog:
    """A log that was opened.

    :param when: when it began, if that is known
    :param problem: what is wrong with the file, as a sentence; empty: nothing
    """

    run: PastRun
    when: datetime | None = None
    problem: str = ""


def open_log(file: Path, height: float, name: str = "") -> OpenedLog:
    """Open a log.

    :param height: that of the field, in feet
    :param name: for people; by default, the file's
    :raises LogError: when nothing of it can be shown
    """
    name = name or file.name
    if file.is_dir():
        raise LogError("this is a directory, not a log", where=name, remedy=_newest_in(file))
    try:
        with file.open("rb") as opened:
            head = opened.read(_HEAD)
    except OSError as wrong:
        raise LogError(f"it cannot be read: {wrong.strerror}", where=name) from None
    if remedy := _FOREIGN.get(Path(name).suffix.lower()):
        raise LogError("this log cannot be read directly", where=name, remedy=remedy)
    if not head:
        raise LogError("this file is empty", where=name)
    if kind := recordings.format_of(head):
        run = recordings.read_recording(file, name, kind)
        return OpenedLog(run, _changed(file), _problem_of(run))
    read: ReadLog
    if is_wpilog(head):
        read = read_wpilog(file)
    elif is_ds_log(head):
        read = _read_station(file, Path(name).suffix.lower() == ".dsevents")
    else:
        raise LogError(NO_LOG, where=name, remedy=_KINDS)
    if not read.columns and not read.happened:
        raise LogError(f"there is nothing in it: {read.problem or 'it has no values'}", where=name)
    return OpenedLog(run_of(read, name, height), when_of(read) or _changed(file), read.problem)


def _read_station(file: Path, is_events: bool) -> ReadLog:
    """Read a log of the driver station, with the events that lie beside it."""
    if is_events:
        return read_ds_events(file)
    read, events = read_ds_log(file), file.with_suffix(".dsevents")
    if events.is_file():
        read.happened += read_ds_events(events).happened
    return read


def _newest_in(directory: Path) -> str:
    """Return which logs a directory has, the newest first."""
    files = [file for file in directory.iterdir() if file.suffix.lower() in _SUFFIXES]
    files.sort(key=lambda file: file.stat().st_mtime, reverse=True)
    names = ", ".join(file.name for file in files[:_MOST_NAMED])
    return f"Its newest logs: {names}" if names else "There are no logs in it."


def _problem_of(run: PastRun) -> str:
    return run.happened[-1].text if run.happened and run.happened[-1].is_mark else ""


def _changed(file: Path) -> datetime:
    return datetime.fromtimestamp(file.stat().st_mtime).astimezone()
