"""The lock, ``pyfrc-lock.toml``: which files a project's robot gets, so that every laptop gives it the same bytes."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..config.toml_file import TomlFile
from ..errors import SettingsError
from ..file_hash import hash_file
from ..project import Project
from ..season import Season
from ..text_files import write_whole

#: The lock's name; it is beside pyproject.toml.
LOCK_FILE = "pyfrc-lock.toml"

#: The name of the robot's Python among the files.
PYTHON = "python"

#: The version of its format.
_FORMAT = 1
_HEAD = """\
# What the robot gets. Written by pyfrc sync: commit it, so that every laptop gives the robot the same. Do not edit it.
"""
_REMEDY = "Take it from version control again, or make a new one: pyfrc sync --upgrade"
_FILE_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.+!-]*")
_HASH = re.compile(r"[0-9a-f]{64}")
_ADDRESS = re.compile(r"https?://[^\s]+")


@dataclass(frozen=True)
class LockedFile:
    """A file that the robot gets.

    :param name:    the package, in its normalized form such as ``robotpy-hal``; ``python`` for the season's Python
    :param version: its version
    :param file:    the file's name, without a directory
    :param size:    in bytes
    :param sha256:  in hexadecimal
    :param url:     the address to download it from; None for a file that came from a directory
    :param index:   the package index that it came from; None for a file that came from elsewhere
    """

    name: str
    version: str
    file: str
    size: int
    sha256: str
    url: str | None = None
    index: str | None = None

    def __str__(self) -> str:
        return f"{'Python' if self.name == PYTHON else self.name} {self.version}"

    def is_at(self, path: Path) -> bool:
        """Return whether the file at a path has this size and hash."""
        try:
            return path.stat().st_size == self.size and hash_file(path) == (self.sha256, self.size)
        except OSError:
            return False


@dataclass(frozen=True)
class Lock:
    """What a project's robot gets.

    :param season:       the season's year
    :param controller:   the product name of the robot's controller, such as ``SystemCore``
    :param requirements: what the packages were found for, as pip takes it, sorted
    :param python:       the robot's Python
    :param packages:     wheels, sorted by name; each package once
    """

    season: int
    controller: str
    requirements: tuple[str, ...]
    python: LockedFile
    packages: tuple[LockedFile, ...]

    @property
    def files(self) -> tuple[LockedFile, ...]:
        """All files, Python first."""
        return (self.python, *self.packages)


def is_file_name(text: str) -> bool:
    """Return whether a lock can have a file of this name."""
    return _FILE_NAME.fullmatch(text) is not None


def lock_file_of(project: Project) -> Path:
    """Return the path of a project's lock, which may not exist."""
    return project.pyproject.parent / LOCK_FILE


def load_lock(file: Path, season: Season) -> Lock | None:
    """Return the lock in a file, or None if there is no such file.

    :param season: the project's
    :raises SettingsError: for a damaged lock, naming the line; and for one of another season or controller
    """
    if not file.is_file():
        return None
    try:
        document = TomlFile(file)
    except SettingsError as malformed:
        raise SettingsError(
            f"this lock is damaged: {malformed.message}", where=malformed.where, remedy=_REMEDY
        ) from None
    lock = _Reader(document).lock()
    if (lock.season, lock.controller) != (season.year, season.controller.name):
        raise SettingsError(
            f"this is for the {lock.controller} of {lock.season}, and the project for the {season.controller.name} of "
            f"{season.year}",
            where=file.name,
            remedy="To make the one of the project's season: pyfrc sync --upgrade",
        )
    return lock


def changes(before: Lock, after: Lock) -> Iterator[str]:
    """Yield the changes for the robot, each as one line."""
    old = {each.name: each for each in before.files}
    new = {each.name: each for each in after.files}
    for name in sorted(old.keys() | new.keys()):
        if name not in old:
            yield f"+ {new[name]}"
        elif name not in new:
            yield f"- {old[name]}"
        elif old[name].version != new[name].version:
            other = new[name].index if old[name].index not in (None, new[name].index) else None
            yield f"{old[name]} -> {new[name].version}{f', now from {other}' if other else ''}"
        elif old[name].sha256 != new[name].sha256:
            yield f"{new[name]}: another file of this version"
    for requirement in after.requirements:
        if requirement not in before.requirements:
            yield f"asked for now: {requirement}"
    for requirement in before.requirements:
        if requirement not in after.requirements:
            yield f"no longer asked for: {requirement}"


def save_lock(file: Path, lock: Lock) -> None:
    """Write a lock. The same lock is always the same text."""
    write_whole(file, _text(lock))


def _text(lock: Lock) -> Iterator[str]:
    yield _HEAD
    yield f"version = {_FORMAT}\nseason = {lock.season}\ncontroller = {_quoted(lock.controller)}\n"
    yield "requirements = [\n"
    for requirement in lock.requirements:
        yield f"    {_quoted(requirement)},\n"
    yield "]\n"
    for locked in lock.files:
        yield "\n[python]\n" if locked is lock.python else f"\n[[package]]\nname = {_quoted(locked.name)}\n"
        yield f"version = {_quoted(locked.version)}\nfile = {_quoted(locked.file)}\n"
        yield f"size = {locked.size}\nsha256 = {_quoted(locked.sha256)}\n"
        for key, address in (("url", locked.url), ("index", locked.index)):
            if address is not None:
                yield f"{key} = {_quoted(address)}\n"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")  # a string of JSON is one of TOML


class _Reader:
    """Checks a lock while it is read: its names become paths, on this computer and on the robot."""

    def __init__(self, document: TomlFile) -> None:
        self._document = document

    def lock(self) -> Lock:
        content = self._document.content
        version = content.get("version")
        if version != _FORMAT:
            newer = isinstance(version, int) and version > _FORMAT
            wrong = f"a newer pyfrc wrote it (format {version})" if newer else "it does not begin as a lock of pyfrc's"
            raise self._error(wrong, "version", remedy="Update pyfrc." if newer else _REMEDY)
        season, requirements, packages = (content.get(key) for key in ("season", "requirements", "package"))
        if type(season) is not int:
            raise self._error("season must be a year", "season")
        if not isinstance(requirements, list) or not all(isinstance(each, str) for each in requirements):
            raise self._error("requirements must be a list of texts", "requirements")
        python = content.get("python")
        if not isinstance(python, dict):
            raise self._error("[python] is missing", "python")
        if not isinstance(packages, list | None):
            raise self._error("package must be a list of tables", "package")
        found = [self._file(PYTHON, python), *(self._package(each) for each in packages or [])]
        for what in ("name", "file"):
            values = [getattr(each, what).casefold() for each in found]
            if (double := next((value for value in values if values.count(value) > 1), None)) is not None:
                raise self._error(f"{double} is there twice", "package")
        controller = self._text(content, "controller", "controller")
        return Lock(season, controller, tuple(requirements), found[0], tuple(found[1:]))

    def _package(self, table: object) -> LockedFile:
        if not isinstance(table, dict):
            raise self._error("package must be a list of tables", "package")
        return self._file(self._text(table, "name", "package", _FILE_NAME), table)

    def _file(self, name: str, table: dict[str, Any]) -> LockedFile:
        key = PYTHON if name == PYTHON else "package"
        size = table.get("size")
        if type(size) is not int or size < 0:
            raise self._error(f"{name}: size must be a number of bytes", key)
        url, index = (self._address(name, table, each) for each in ("url", "index"))
        version = self._text(table, "version", key, _FILE_NAME)
        file = self._text(table, "file", key, _FILE_NAME)
        return LockedFile(name, version, file, size, self._text(table, "sha256", key, _HASH), url, index)

    def _address(self, name: str, table: dict[str, Any], key: str) -> str | None:
        address = table.get(key)
        if address is None or (isinstance(address, str) and _ADDRESS.fullmatch(address)):
            return address
        where = PYTHON if name == PYTHON else "package"
        raise self._error(f"{name}: {key} must be an address with http: or https:", where)

    def _text(self, table: dict[str, Any], key: str, where: str, allowed: re.Pattern[str] | None = None) -> str:
        value = table.get(key)
        if not isinstance(value, str) or (allowed is not None and allowed.fullmatch(value) is None):
            name = f"{table['name']}: " if isinstance(table.get("name"), str) and key != "name" else ""
            wrong = "is missing" if value is None else f"cannot be {value!r}"
            raise self._error(f"{name}{key} {wrong}", where)
        return value

    def _error(self, text: str, key: str, remedy: str = _REMEDY) -> SettingsError:
        line = self._document.line_of((key,))
        where = self._document.name if line is None else f"{self._document.name}:{line}"
        return SettingsError(f"this lock is damaged: {text}" if remedy == _REMEDY else text, where=where, remedy=remedy)
