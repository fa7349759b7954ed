"""The season's cache on this computer, which the season's own tool uses too: ``~/wpilib/2027/robotpy``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import PyfrcError
from ..file_lock import lock
from ..season import Season
from .lock import PYTHON, LockedFile

#: The file in a cache that a process locks while it changes the cache.
LOCKED_WHILE_CHANGED = ".pyfrc-sync.lock"


class NotSyncedError(PyfrcError):
    """A file that the robot needs is not on this computer, or has another content than the lock says."""


class Cache:
    """A season's cache.

    :param root: its directory
    """

    def __init__(self, root: Path, season: Season) -> None:
        self.root = root
        self._python = root / season.downloads.python_cache
        self._packages = root / "pip_cache"

    def path_of(self, locked: LockedFile) -> Path:
        """Return where a file is or would be."""
        return (self._python if locked.name == PYTHON else self._packages) / locked.file

    def has(self, locked: LockedFile) -> bool:
        """Return whether a file is there, with the locked size and hash."""
        return locked.is_at(self.path_of(locked))

    @contextmanager
    def changed_alone(self, waiting: Callable[[], None]) -> Iterator[None]:
        """Let only one process at a time change the cache: all use the same names for incomplete files.

        :param waiting: is called if another process is changing it
        """
        self.root.mkdir(parents=True, exist_ok=True)
        with (self.root / LOCKED_WHILE_CHANGED).open("ab") as file:
            if not lock(file, wait=False):
                waiting()
                lock(file)
            yield


def cache_of(season: Season) -> Cache:
    """Return a season's cache in the user's home directory."""
    return Cache(Path.home() / "wpilib" / str(season.year) / "robotpy", season)


def cached_file(locked: LockedFile, season: Season) -> Path:
    """Return the path of a locked file in the season's cache. Its hash has been checked.

    :raises NotSyncedError: if it is not there, or has another content
    """
    cache = cache_of(season)
    path = cache.path_of(locked)
    if cache.has(locked):
        return path
    wrong = "has another content than the lock says" if path.exists() else "is not on this computer yet"
    remedy = f"With internet: pyfrc sync. Without: copy {cache.root} from a computer that has run pyfrc sync."
    raise NotSyncedError(f"{locked} for the robot {wrong} ({path})", remedy=remedy)
