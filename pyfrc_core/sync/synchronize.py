"""`pyfrc sync`: from a project to a lock, and the files that it names in the season's cache."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from ..errors import PyfrcError, SettingsError, UsageError
from ..file_hash import hash_file
from ..project import Project
from ..season import Season
from ..wording import size_text
from .addresses import PYTHON_VARIABLE, file_name_in, link_directories, replaced_python_url
from .cache import Cache, cache_of
from .download import Download, Downloader, DownloadError, cannot_write
from .lock import PYTHON, Lock, LockedFile, is_file_name, load_lock, lock_file_of, save_lock
from .pip_errors import NothingFitsError
from .resolve import find_packages, source_of
from .wanted import Wanted, load_wanted
from .wheels import check_wheels


@dataclass(frozen=True)
class SyncOptions:
    """The options of `pyfrc sync`.

    :param upgrade:     find new versions, also where the lock has one
    :param find_links:  further places where pip looks for packages: directories and addresses
    :param use_certifi: trust the certificates of the package certifi
    """

    upgrade: bool = False
    find_links: Sequence[str] = ()
    use_certifi: bool = False


class SyncProgress(Protocol):
    """Shows what is being done."""

    def waiting(self) -> None:
        """Show that another process is changing the cache."""

    def finding(self, package: str) -> None:
        """Show that pip looks at a package."""

    def note(self, text: str) -> None:
        """Show a sentence about the packages."""

    def received(self, what: str, there: int, total: int | None) -> None:
        """Show how many bytes of a file are there; `total` is None if unknown."""

    def got(self, locked: LockedFile, how: str, url: str | None = None) -> None:
        """Show that a file is complete, and how it was got, such as ``downloaded``; `url` is its address."""


@dataclass(frozen=True)
class Synced:
    """The result.

    :param lock:     what the robot gets
    :param previous: the project's lock before; None if there was none that fits
    """

    lock: Lock
    previous: Lock | None


def synchronize(
    project: Project, season: Season, installed: str | None, options: SyncOptions, progress: SyncProgress
) -> Synced:
    """Have all that a project's robot needs in the season's cache, and its lock beside pyproject.toml.

    :param installed: the version of WPILib on this computer
    :raises PyfrcError: if something cannot be had; the lock and the complete files in the cache are as before then
    """
    file = lock_file_of(project)
    wanted = load_wanted(project.pyproject, season, installed)
    cache = cache_of(season)
    with cache.changed_alone(progress.waiting):
        previous = _previous(file, season, options.upgrade)
        work = _Work(season, cache, options, progress)
        if previous is not None and previous.requirements == wanted.locked and not options.upgrade:
            lock = previous
            work.get_all(lock)
        else:
            lock = work.make_lock(wanted, previous, keep=not options.upgrade)
        for text in check_wheels(lock, season, cache):
            progress.note(text)
        if lock != previous:
            save_lock(file, lock)
    return Synced(lock, previous)


def differences(project: Project, season: Season, installed: str | None) -> Iterator[str]:
    """Yield why the robot would not get what the project asks for, each as a sentence.

    :raises SettingsError: for a lock that cannot be read
    """
    lock = load_lock(lock_file_of(project), season)
    if lock is None:
        yield f"there is no {lock_file_of(project).name}"
        return
    wanted = load_wanted(project.pyproject, season, installed).locked
    for requirement in wanted:
        if requirement not in lock.requirements:
            yield f"{project.pyproject.name} asks for {requirement}, which the lock does not have"
    for requirement in lock.requirements:
        if requirement not in wanted:
            yield f"the lock is for {requirement}, which {project.pyproject.name} does not ask for"
    cache = cache_of(season)
    for each in lock.files:
        if not cache.has(each):
            wrong = "another content" if cache.path_of(each).exists() else "not on this computer"
            yield f"{each}: {wrong} ({each.file})"


def _previous(file: Path, season: Season, upgrade: bool) -> Lock | None:
    try:
        return load_lock(file, season)
    except SettingsError:
        if upgrade:
            return None
        raise


def _refuse_other_index(found: LockedFile, old: LockedFile | None) -> None:
    """Refuse another version from another index than the locked one: it may be a stranger's of the same name."""
    if old is None or old.version == found.version:
        return
    now, before = found.index, old.index
    if before is None:  # from a directory; or an older version has locked only the address
        now, before = (source_of(each.url or "file:") for each in (found, old))
    if now == before:
        return
    places = [f"from {each}" if each else "from a directory" for each in (now, before)]
    raise PyfrcError(
        f"{found} would come {places[0]}, and the locked {old.version} came {places[1]}",
        remedy="If that is right: pyfrc sync --upgrade. Otherwise, check pip's settings: pip config list",
    )


def _without_file(url: str | None) -> str | None:
    """Return an address for the lock: none for a file, which only this computer has."""
    return None if url is None or url.startswith("file:") else url


class _Work:
    """Gets files into the cache."""

    def __init__(self, season: Season, cache: Cache, options: SyncOptions, progress: SyncProgress) -> None:
        self._season = season
        self._cache = cache
        self._options = options
        self._progress = progress
        self._directories = link_directories(options.find_links)
        self._downloader = Downloader(options.use_certifi)

    def get_all(self, lock: Lock) -> None:
        """Get the locked files that the cache lacks."""
        for each in self._missing(lock):
            self._get(each)

    def make_lock(self, wanted: Wanted, previous: Lock | None, keep: bool) -> Lock:
        """Find the packages, and get the files.

        :param keep: whether to take the versions of the previous lock where they fit
        """
        old = {each.name: each for each in previous.packages} if previous is not None and keep else {}
        found = self._find(wanted, old)
        for each in found:
            _refuse_other_index(each, old.get(each.name))
        python = self._python(previous.python if previous is not None and keep else None)
        packages = [self._package(each, old.get(each.name)) for each in found]
        controller = self._season.controller.name
        return Lock(self._season.year, controller, wanted.locked, python, tuple(packages))

    def _find(self, wanted: Wanted, old: dict[str, LockedFile]) -> list[LockedFile]:
        requirements = list(wanted.locked)
        constraints = [f"{each.name}=={each.version}" for each in old.values()]
        meta = self._season.downloads.packages
        newest = [f"{meta}=={wanted.version}"] if wanted.version is not None else []
        links = [str(Path(each).absolute()) if Path(each).is_dir() else each for each in self._options.find_links]

        def find(limits: list[str]) -> list[LockedFile]:
            return find_packages(
                requirements, self._season, constraints=limits, find_links=links, finding=self._progress.finding
            )

        if constraints:
            try:
                return find(constraints)
            except NothingFitsError:  # the requirements do not fit these versions any more
                pass
        return find(newest)

    def _python(self, locked: LockedFile | None) -> LockedFile:
        """Get the robot's Python.

        :param locked: the one to get; None: the season's
        """
        if locked is not None:
            if not self._cache.has(locked):
                self._get(locked)
            return locked
        url = replaced_python_url() or self._season.downloads.python_url
        file = file_name_in(url)
        if not is_file_name(file):
            text = f"{PYTHON_VARIABLE} is {url}, whose last part cannot be the name of a file in the lock"
            raise UsageError(text, remedy="Use letters, digits and ._+-! in its name, such as python.tar.gz.")
        python = LockedFile(PYTHON, self._season.downloads.python, file, 0, "", _without_file(url))
        return self._get(python, url)

    def _package(self, found: LockedFile, old: LockedFile | None) -> LockedFile:
        new = replace(found, url=_without_file(found.url))
        if old is not None and old.version == found.version:
            new = replace(old, index=found.index) if old.url == new.url else old
        if new.size and self._cache.has(new):
            return new
        there = self._cache.path_of(new)
        if new.sha256 and there.is_file() and hash_file(there)[0] == new.sha256:
            return replace(new, size=there.stat().st_size)
        return self._get(new, found.url)

    def _get(self, locked: LockedFile, url: str | None = None) -> LockedFile:
        """Get one file, and return it with its size and hash."""
        replaced = replaced_python_url() if locked.name == PYTHON else None
        url = replaced or url or locked.url
        if locked.sha256 and (directory := self._directory_with(locked)) is not None:
            self._copy(locked, directory)
            return locked
        if url is None:
            raise PyfrcError(
                f"{locked} has no address in the lock: it came from a directory",
                remedy="Name that directory: pyfrc sync --find-links DIRECTORY",
            )
        path = self._cache.path_of(locked)

        def advanced(there: int, total: int | None) -> None:
            self._progress.received(str(locked), there, total)

        variable = PYTHON_VARIABLE if replaced else None
        wanted = Download(str(locked), url, path, locked.sha256 or None, locked.size, variable)
        downloaded = self._downloader.get(wanted, advanced)
        sha256, size = hash_file(path)
        if locked.size and locked.size != size:  # cannot be with the same hash
            raise DownloadError(f"{locked}: the lock has a wrong size", remedy="Run pyfrc sync --upgrade.")
        whole = replace(locked, sha256=sha256, size=size)
        if downloaded:
            self._progress.got(whole, "copied" if url.startswith("file:") else "downloaded", url)
        if not locked.sha256:
            self._progress.note(f"{whole} has no published hash; from {url}: SHA-256 {sha256}")
        return whole

    def _directory_with(self, locked: LockedFile) -> Path | None:
        return next((each for each in self._directories if locked.is_at(each / locked.file)), None)

    def _copy(self, locked: LockedFile, source: Path) -> None:
        """Copy a file into the cache, so that it appears only when complete."""
        to = self._cache.path_of(locked)
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
        self._progress.got(locked, "copied")

    def _missing(self, lock: Lock) -> list[LockedFile]:
        """Return the files that the cache lacks. Refuse to go on if the disk has no space for them."""
        missing = [each for each in lock.files if not self._cache.has(each)]
        needed = sum(each.size for each in missing)
        place = self._cache.root
        while not place.exists():
            place = place.parent
        if needed > shutil.disk_usage(place).free:
            raise PyfrcError(
                f"the disk is too full: {size_text(needed)} are needed in {self._cache.root}",
                remedy="Free some space, and run pyfrc sync again.",
            )
        return missing
