"""The processes that this one has started, and those that they have started. Linux only."""

from __future__ import annotations

import ctypes
import os
import signal
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

_PR_SET_CHILD_SUBREAPER = 36
_TICKS = os.sysconf("SC_CLK_TCK")

# Fields of /proc/PID/stat after the name, which may have spaces.
_STATE, _PARENT, _TIMES = 0, 1, slice(11, 15)


def adopt_orphans() -> None:
    """From now on, processes below this one stay below it when their parent ends."""
    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1)


def used_cpu_seconds() -> float:
    """Return the processor time of all processes below this one, with those of theirs that have ended."""
    return sum(sum(map(int, fields[_TIMES])) for fields in _below().values()) / _TICKS


def is_blocked() -> bool:
    """Return whether none of them has a thread that could run."""
    for process in _below():
        with suppress(OSError):
            for task in Path(f"/proc/{process}/task").iterdir():
                if _fields(task)[_STATE] in "RD":
                    return False
    return True


def end_processes_below() -> None:
    """Kill them all."""
    while processes := _below():
        for process in processes:
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        with suppress(ChildProcessError):
            while os.waitpid(-1, 0):
                pass


def _below() -> dict[int, list[str]]:
    children: dict[int, list[int]] = {}
    found: dict[int, list[str]] = {}
    for process, fields in _all():
        children.setdefault(int(fields[_PARENT]), []).append(process)
        found[process] = fields
    below: dict[int, list[str]] = {}
    parents = [os.getpid()]
    while parents:
        for child in children.get(parents.pop(), ()):
            below[child] = found[child]
            parents.append(child)
    return below


def _all() -> Iterator[tuple[int, list[str]]]:
    for directory in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            yield int(directory.name), _fields(directory)


def _fields(directory: Path) -> list[str]:
    return (directory / "stat").read_text().rpartition(")")[2].split()
