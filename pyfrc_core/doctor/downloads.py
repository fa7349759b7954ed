"""Checks whether what the robot needs is on this computer, as `pyfrc sync` downloads it."""

from __future__ import annotations

from collections.abc import Iterator

from ..errors import PyfrcError
from ..project import Project
from ..season import Season
from ..sync import LOCK_FILE, load_lock, lock_file_of
from ..sync.install import different_here
from ..sync.synchronize import differences
from ..wording import counted
from .check_result import CheckResult, hint, ok
from .robot_project import problem_from_error

TOPIC = "sync"
_MAX_NAMED = 3


def check_downloads(project: Project, season: Season, installed: str) -> Iterator[CheckResult]:
    """Check the project's lock, the files that it names, and whether the same versions are installed here.

    :param installed: the version of WPILib on this computer
    """
    try:
        lock = load_lock(lock_file_of(project), season)
        if lock is None:
            text = f"there is no {LOCK_FILE}: what the robot needs was not downloaded with pyfrc"
            yield hint(TOPIC, text, "With internet: pyfrc sync. A robot that has all it needs works without.")
            return
        found = list(differences(project, season, installed))
    except (PyfrcError, OSError) as error:
        yield problem_from_error(TOPIC, error, "pyfrc sync --upgrade")
        return
    if found:
        more = f"; and {len(found) - _MAX_NAMED} more" if len(found) > _MAX_NAMED else ""
        yield hint(TOPIC, f"{'; '.join(found[:_MAX_NAMED])}{more}", "With internet: pyfrc sync")
    else:
        yield ok(TOPIC, f"{counted(len(lock.files), 'file')} for the {lock.controller} are on this computer")
    if others := list(different_here(lock)):
        more = f" and {len(others) - _MAX_NAMED} more" if len(others) > _MAX_NAMED else ""
        text = f"this computer has {', '.join(others[:_MAX_NAMED])}{more}"
        yield hint(TOPIC, text, "For the robot's versions here, too: pyfrc sync --install")
