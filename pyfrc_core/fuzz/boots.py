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

from ..processes.call import ForkedCall, can_fork, run_in_subprocess
from ..processes.crash_report import CrashLog
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


class PlayBoot(Protocol[Result]):
    """Plays one boot in this process, which must end afterwards; can be pickled."""

    def __call__(self, project: Project, log: CrashLog, before: Result | None) -> Result:
        """Return the result, which contains that of the boots before."""


def play_boots(project: Project, play_boot: PlayBoot[Result], quietly: bool = True) -> Result:
    """Play one boot after the other, each in another process, and return the result of the last one.

    :param quietly: whether nothing that they print is shown
    :raises RobotCodeError: when a process ends without a result
    """
    played: Result | None = None
    while played is None or played.next_boot is not None:
        played = _call(project, partial(play_boot, before=played), quietly)
    return played


def _call(project: Project, work: Callable[[Project, CrashLog], Result], quietly: bool) -> Result:
    if not can_fork(project):
        return run_in_subprocess(work, project, MEANWHILE, quietly)
    call: ForkedCall[Result] = ForkedCall(partial(work, project), quietly)
    with closing(call):
        call.wait()
        return call.result(project.files, MEANWHILE)
