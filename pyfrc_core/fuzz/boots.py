"""Play a match in which the robot program is started again: each boot in its own process.

A program cannot be started twice in one process: its modules, and WPILib's, keep what the first boot has set. What a
boot leaves to the next one is sent between the processes.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol, TypeVar

from ..processes.call import ForkedCall, run_in_subprocess
from ..processes.crash_report import CrashLog
from ..processes.fork import FORK_IS_SAFE, wait_for_any
from ..project import Project
from ..runtime.scripts.boots import PersistentEntry, persistent_entries

#: When robot code ends its process.
MEANWHILE = "in the middle of the match"


@dataclass(frozen=True)
class NextBoot:
    """What the next boot of the robot program needs of those before.

    :param number: its number; the first boot of a match is 0
    :param at_us: when the program starts again
    :param entries: the persistent entries of NetworkTables
    :param rng_state: the state of the generator of the match's random numbers
    """

    number: int
    at_us: int
    entries: tuple[PersistentEntry, ...]
    rng_state: Any = None

    @staticmethod
    def after(number: int, at_us: int, rng_state: Any = None) -> NextBoot:
        """Return what the boot with this number, which has just ended in this process, leaves to the next one."""
        return NextBoot(number + 1, at_us, persistent_entries(), rng_state)


class BootResult(Protocol):
    """The result of a boot."""

    @property
    def next_boot(self) -> NextBoot | None:
        """What the next boot needs; None if the match is over."""


Result = TypeVar("Result", bound=BootResult)


def play_boots(project: Project, play_boot: Callable[[Project, CrashLog, Result | None], Result]) -> Result:
    """Play one boot after the other, and return the result of the last one, which contains those before.

    :param play_boot: called in another process with the result of the boots before; can be pickled
    :raises RobotCodeError: when a process ends without a result
    """
    played: Result | None = None
    while played is None or played.next_boot is not None:
        played = _call(project, partial(_play_boot, play_boot=play_boot, before=played))
    return played


def _play_boot(
    project: Project,
    log: CrashLog,
    play_boot: Callable[[Project, CrashLog, Result | None], Result],
    before: Result | None,
) -> Result:
    return play_boot(project, log, before)


def _call(project: Project, work: Callable[[Project, CrashLog], Result]) -> Result:
    if not FORK_IS_SAFE or project.settings.test.isolation == "spawn":
        return run_in_subprocess(work, project, MEANWHILE)
    call: ForkedCall[Result] = ForkedCall(lambda log: work(project, log))
    with closing(call):
        while not call.finished:
            wait_for_any([call.fileno()])
            call.poll()
        return call.result(project.files, MEANWHILE)
