"""Which of the wanted contents are on the robot already, by their hashes."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from .activity import Activity
from .disk import BLOCK, files_below
from .places import Refusal
from .releases import Releases

DEPLOY_JSON = "deploy.json"


class Wanted(NamedTuple):
    """A file as it is to be on the robot."""

    path: str
    size: int
    sha256: str
    executable: bool


def wanted_of(files: Iterable[Any]) -> list[Wanted]:
    """The manifest that the laptop has sent; every path stays in the code's directory."""
    wanted = [Wanted(str(path), int(size), str(sha256), bool(executable)) for path, size, sha256, executable in files]
    for each in wanted:
        if "\0" in each.path or any(part in ("", ".", "..") for part in each.path.split("/")):
            raise Refusal("path", f"{each.path!r} is no path within the program's directory")
    if len({each.path for each in wanted}) != len(wanted):
        raise Refusal("path", "the manifest has the same path twice")
    return [each for each in wanted if each.path != DEPLOY_JSON]


class ContentIndex:
    """Which of the wanted contents are on the robot already.

    The program in place is searched first, and the other releases only where something is missing in it. Each file of
    a size that is wanted is read and hashed: the program may have changed it, whatever its time says.
    """

    def __init__(self, releases: Releases, wanted: list[Wanted], activity: Activity) -> None:
        self._activity = activity
        self._wanted = {each.path: each for each in wanted}
        self._sizes, self._hashes = {each.size for each in wanted}, {each.sha256 for each in wanted}
        self._copies: dict[str, str] = {}
        self._same: dict[str, str] = {}
        #: The hashes of files by device and inode: a file of several releases is read once.
        self._known: dict[tuple[int, int], str] = {}
        code = releases.code()
        places = [] if code is None else [code]
        places += [releases.directory(number).resolve() for number in reversed(releases.numbers())]
        for directory in dict.fromkeys(places):
            if len(self._same) == len(wanted):
                break
            activity.begin("check", len(wanted))
            self._add(directory, releases.listed(directory))
        self._known.clear()

    def _add(self, directory: Path, listed: set[str] | None) -> None:
        for name, entry in files_below(directory):
            self._activity.step()
            try:
                state = os.lstat(entry.path)  # not the entry's: on Windows that has no inode
                if state.st_size not in self._sizes:
                    continue
                identity = (state.st_dev, state.st_ino)
                if identity not in self._known:
                    self._known[identity] = sha256_of(entry.path, self._activity)
            except OSError:
                continue  # the program that runs may remove and replace its files
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

    def same_file(self, wanted: Wanted) -> str | None:
        """The file of this very name and content, in a release: it can be linked. Others might be the program's own."""
        return self._same.get(wanted.path)

    def copy(self, wanted: Wanted) -> str | None:
        """A file with this content."""
        return self._copies.get(wanted.sha256)

    def missing(self, wanted: Iterable[Wanted]) -> list[Wanted]:
        """The files whose contents the laptop has to send, each content once.

        Sources are first: they are compiled while the rest is received.
        """
        first: dict[str, Wanted] = {}
        for each in wanted:
            if self.copy(each) is None:
                first.setdefault(each.sha256, each)
        return sorted(first.values(), key=lambda each: not each.path.endswith(".py"))

    def has(self, wanted: Wanted, code: Path) -> bool:
        """Whether the file of this name in the directory `code` is as wanted."""
        file, same = code / wanted.path, self.same_file(wanted)
        return same is not None and file.is_file() and (same == str(file) or file.samefile(same))


def sha256_of(file: str, activity: Activity) -> str:
    """The SHA-256 of a file's content, in hexadecimal."""
    digest = hashlib.sha256()
    descriptor = os.open(file, os.O_RDONLY)
    try:
        while block := os.read(descriptor, BLOCK):
            digest.update(block)
            activity.step(0)
    finally:
        os.close(descriptor)
    return digest.hexdigest()
