"""Opens a log, whatever it is, or says in one sentence why not."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from ...errors import PyfrcError
from ...log_formats import FOREIGN_LOGS
from ...runtime.scripts.file_kinds import described, is_data_log, is_ds_log, read_head
from ..engine.past_run import PastRun
from . import recordings
from .columns import ReadLog
from .ds_log import read_ds_events, read_ds_log
from .layout import run_of, when_of
from .wpilog import read_wpilog

_KINDS = "Logs are .wpilog, .wpilogxz, .rlog, .dslog and .dsevents, and recordings and traces of pyfrc (.jsonl)."


class LogError(PyfrcError):
    """A file cannot be shown as a log."""


@dataclass(frozen=True)
class OpenedLog:
    """A log that was opened.

    :param when: when it began, if that is known
    :param problem: what is wrong with the file, as a sentence; empty: nothing
    :param file: where it is
    :param read: what the file has; None for recordings of pyfrc
    :param is_station: whether it is a log of the driver station
    """

    run: PastRun
    file: Path
    when: datetime | None = None
    problem: str = ""
    read: ReadLog | None = None
    is_station: bool = False


def open_log(file: Path, height: float, name: str = "") -> OpenedLog:
    """Open a log.

    :param height: that of the field, in feet
    :param name: for people; by default, the file's
    :raises LogError: when nothing of it can be shown
    """
    name = name or file.name
    head = read_head(file, "a log", LogError, name)
    if remedy := FOREIGN_LOGS.get(Path(name).suffix.lower()):
        raise LogError("this log cannot be read directly", where=name, remedy=remedy)
    if not head:
        raise LogError("this file is empty", where=name)
    if kind := recordings.format_of(head):
        run, problem = recordings.read_recording(file, name, kind)
        return OpenedLog(run, file, _changed(file), problem)
    is_station = is_ds_log(head)
    if is_data_log(head, name):
        read = read_wpilog(file)
    elif is_station:
        read = _read_station(file, Path(name).suffix.lower() == ".dsevents")
    else:
        what, remedy = described(head, name)
        raise LogError(f"this is {what}, not a log", where=name, remedy=remedy or _KINDS)
    if not read.columns and not read.happened:
        raise LogError(f"there is nothing in it: {read.problem or 'it has no values'}", where=name)
    when = when_of(read) or _changed(file)
    return OpenedLog(run_of(read, name, height), file, when, read.problem, read, is_station)


def _read_station(file: Path, is_events: bool) -> ReadLog:
    """Read a log of the driver station, with the events that lie beside it."""
    if is_events:
        return read_ds_events(file)
    read, events = read_ds_log(file), file.with_suffix(".dsevents")
    if events.is_file():
        read.happened += read_ds_events(events).happened
    return read


def _changed(file: Path) -> datetime:
    return datetime.fromtimestamp(file.stat().st_mtime).astimezone()
