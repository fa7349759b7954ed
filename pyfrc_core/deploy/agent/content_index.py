"""An index of file contents that are already on the robot, by hash."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from .activity import Activity
from .disk import files_below, sha256_of
from .releases import Releases
from .robot_paths import Refusal

DEPLOY_JSON = "deploy.json"


class WantedFile(NamedTuple):
    """A file of the laptop's manifest."""

    path: str
    size: int
    sha256: str
    executable: bool


def parse_manifest(files: Iterable[Any]) -> list[WantedFile]:
    """Return the files of the laptop's manifest.

    :raises Refusal: if a path is not relative to the code's directory, or occurs twice
    """
    wanted = [
        WantedFile(str(path), int(size), str(sha256), bool(executable)) for path, size, sha256, executable in files
    ]
    for each in wanted:
        if "\0" in each.path or any(part in ("", ".", "..") for part in each.path.split("/")):
            raise Refusal("path", f"{each.path!r} is not a path within the program's directory")
    if len({each.path for each in wanted}) != len(wanted):
        raise Refusal("path", "the manifest has the same path twice")
    return [each for each in wanted if each.path != DEPLOY_JSON]


class ContentIndex:
    """Finds wanted contents that are already on the robot.

    The current program is searched first, and other releases only for files that it lacks. Each file with a wanted
    size is read and hashed, since the program may have changed it without changing its modification time.
    """

    def __init__(self, releases: Releases, wanted: list[WantedFile], activity: Activity) -> None:
        self._activity = activity
        self._wanted = {each.path: each for each in wanted}
        self._sizes, self._hashes = {each.size for each in wanted}, {each.sha256 for each in wanted}
        self._copies: dict[str, str] = {}
        self._same: dict[str, str] = {}
        #: Hashes by device and inode, so that a file of several releases is read once.
        self._known: dict[tuple[int, int], str] = {}
        code = releases.code()
        directories = [] if code is None else [code]
        directories += [releases.directory(number).resolve() for number in reversed(releases.numbers())]
        for directory in dict.fromkeys(directories):
            if len(self._same) == len(wanted):
                break
            activity.begin("check", len(wanted))
            self._add(directory, releases.manifest_paths(directory))
        self._known.clear()

    def _add(self, directory: Path, listed: set[str] | None) -> None:
        for name, entry in files_below(directory):
            self._activity.step()
            try:
                state = os.lstat(entry.path)  # not DirEntry.stat, which has no inode on Windows
                if state.st_size not in self._sizes:
                    continue
                identity = (state.st_dev, state.st_ino)
                if identity not in self._known:
                    self._known[identity] = sha256_of(entry.path, self._activity)
            except OSError:
                continue  # removed or replaced by the running program
            sha256 = self._known[identity]
            if sha256 not in self._hashes:
                continue
            self._copies.setdefault(sha256, entry.path)
            wanted = self._wanted.get(name)
            if (
                wanted is not None
                and (wanted.sha256, wanted.executable) == (sha256, bool(state.st_mode & 0o100))
                and (listed is None or name in listed)
            ):
                self._same.setdefault(name, entry.path)

    def same_file(self, wanted: WantedFile) -> str | None:
        """Return a file of a release with this path and content, which may be linked, or None.

        Other files may be written by the program.
        """
        return self._same.get(wanted.path)

    def copy(self, wanted: WantedFile) -> str | None:
        """Return a file with this content, or None."""
        return self._copies.get(wanted.sha256)

    def missing(self, wanted: Iterable[WantedFile]) -> list[WantedFile]:
        """Return the files whose contents the laptop has to send, each content once.

        Python sources come first: they are compiled while the rest is received.
        """
        first: dict[str, WantedFile] = {}
        for each in wanted:
            if self.copy(each) is None:
                first.setdefault(each.sha256, each)
        return sorted(first.values(), key=lambda each: not each.path.endswith(".py"))

    def has(self, wanted: WantedFile, code: Path) -> bool:
        """Return whether the directory `code` has this file with the wanted content."""
        return self.same_file(wanted) == str(code / wanted.path)
