"""A directory, such as a USB stick, that carries what a lock names to a computer without internet."""

from __future__ import annotations

import shutil
from pathlib import Path

from ..errors import PyfrcError, UsageError
from ..file_hash import hash_file
from ..season import Season
from ..wording import size_text
from .cache import cache_of
from .download import cannot_write
from .lock import LOCK_FILE, Lock, LockedFile, load_lock, save_lock


def carry(lock: Lock, season: Season, to: Path) -> int:
    """Copy the lock and all that it names from the cache, which has it, into a directory. Return how many were copied.

    Files that are there already are kept.

    :raises PyfrcError: if the directory cannot be written
    """
    try:
        to.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise UsageError(f"--to {to} is a file", remedy="Name a directory.") from None
    cache, missing = cache_of(season), [each for each in lock.files if not each.is_at(to / each.file)]
    needed, free = sum(each.size for each in missing), shutil.disk_usage(to).free
    if needed > free:
        text = f"{to} has {size_text(free)} free, and {size_text(needed)} are needed"
        raise PyfrcError(text, remedy="Free some space there, or take another directory.")
    for each in missing:
        take(each, cache.path_of(each).parent, to / each.file)
    save_lock(to / LOCK_FILE, lock)
    return len(missing)


def lock_in(source: Path, season: Season) -> Lock:
    """Return the lock in a directory that `carry` has filled.

    :raises PyfrcError: if there is none
    """
    if not source.is_dir():
        raise UsageError(f"--from {source}: there is no such directory", remedy="Name one that pyfrc sync --to filled.")
    lock = load_lock(source / LOCK_FILE, season)
    if lock is None:
        raise PyfrcError(
            f"there is no {LOCK_FILE}, neither in the project nor in {source}",
            remedy="Fill the directory on a computer with internet, in this project: pyfrc sync --to DIRECTORY",
        )
    return lock


def take(locked: LockedFile, source: Path, to: Path) -> None:
    """Copy a file, so that it appears only when complete."""
    part = to.with_name(f".{to.name}.copy")
    try:
        to.parent.mkdir(parents=True, exist_ok=True)
        if hash_file(source / locked.file, part) != (locked.sha256, locked.size):
            raise PyfrcError(f"{locked.file} in {source} changes while it is read", remedy="Check the USB stick.")
        part.replace(to)
    except OSError as error:
        raise cannot_write(error, to) from None
    finally:
        part.unlink(missing_ok=True)
