"""The project's files to deploy, with their sizes and hashes."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from ..file_hash import hash_file
from .errors import RefusedError

#: Other tools exclude these as well.
_DIRECTORIES_LEFT_OUT = {"__pycache__", "venv", "ctre_sim"}
_SUFFIXES_LEFT_OUT = (".pyc", ".whl", ".ipk", ".zip", ".gz", ".wpilog")
#: Each deploy writes this file on the robot. In a project it can only be a copy.
_WRITTEN_BY_DEPLOYS = "deploy.json"

#: Larger files, in bytes, need --large, since they are usually in the project by mistake.
LARGE = 250_000

_MAX_NAMED = 10


@dataclass(frozen=True)
class Entry:
    """A file to deploy.

    :param path: relative to the code's directory, with forward slashes
    :param size: in bytes
    :param sha256: the hash of its content, in hexadecimal
    :param file: the file on this computer
    """

    path: str
    size: int
    sha256: str
    executable: bool
    file: Path


@dataclass(frozen=True)
class Manifest:
    """All files of a program, sorted by path."""

    entries: tuple[Entry, ...]

    @property
    def total_bytes(self) -> int:
        return sum(entry.size for entry in self.entries)


def build_manifest(root: Path, exclude: Sequence[str] = (), large: bool = False) -> Manifest:
    """Return the files to upload from the program's directory.

    :param exclude: patterns of excluded files, from ``[tool.pyfrc.deploy] exclude``
    :param large: whether to upload files over 250,000 bytes
    :raises RefusedError: with the files that cannot be uploaded
    """
    try:
        found = sorted(_Walk(root, exclude).files())
        refuse_unless_utf8([path for path, _ in found])
        sizes = {path: file.stat().st_size for path, file in found}
        if not large:
            _refuse_large({path: size for path, size in sizes.items() if size > LARGE})
        return Manifest(tuple(_entry(path, file) for path, file in found))
    except OSError as error:
        raise RefusedError(
            f"this cannot be read: {error.strerror or error}",
            where=ascii_path(str(error.filename or root)),
            remedy="Check its owner and permissions, or exclude it with exclude = [...] under [tool.pyfrc.deploy] "
            "in pyproject.toml.",
        ) from error


def is_excluded(path: str, patterns: Sequence[str]) -> bool:
    """Return whether a path (relative, with forward slashes) matches one of the patterns.

    A pattern without a slash matches the name of a file or directory at any depth. A pattern with a slash matches the
    whole path; ``**`` matches any number of directories.
    """
    parts = path.split("/")
    for pattern in patterns:
        wanted = pattern.strip("/").split("/")
        if (len(wanted) == 1 and "/" not in pattern.rstrip("/") and fnmatchcase(parts[-1], wanted[0])) or (
            "/" in pattern.rstrip("/") and _fits(parts, wanted)
        ):
            return True
    return False


def _fits(parts: Sequence[str], wanted: Sequence[str]) -> bool:
    if not wanted:
        return not parts
    if wanted[0] == "**":
        return any(_fits(parts[skipped:], wanted[1:]) for skipped in range(len(parts) + 1))
    return bool(parts) and fnmatchcase(parts[0], wanted[0]) and _fits(parts[1:], wanted[1:])


class _Walk:
    """A walk through a project's directories that follows links within the project."""

    def __init__(self, root: Path, exclude: Sequence[str]) -> None:
        self._root = root.resolve()
        self._exclude = exclude

    def files(self) -> Iterator[tuple[str, Path]]:
        yield from self._within(self._root, "", (self._root,))

    def _within(self, directory: Path, prefix: str, above: tuple[Path, ...]) -> Iterator[tuple[str, Path]]:
        for item in os.scandir(directory):
            path = prefix + item.name
            if item.name.startswith(".") or path == _WRITTEN_BY_DEPLOYS or is_excluded(path, self._exclude):
                continue
            # Checked before the link target: an excluded link may lead outside of the project.
            is_directory = Path(item.path).is_dir()
            if item.name in _DIRECTORIES_LEFT_OUT if is_directory else item.name.endswith(_SUFFIXES_LEFT_OUT):
                continue
            file = self._link_target(path, above) if item.is_symlink() else Path(item.path)
            if is_directory:
                yield from self._within(file, f"{path}/", (*above, file))
            elif stat.S_ISREG(file.stat().st_mode):
                yield path, file
            else:
                raise RefusedError(
                    "this is a device, a pipe or a socket, which cannot be uploaded",
                    where=ascii_path(path),
                    remedy=_EXCLUDE_IT,
                )

    def _link_target(self, path: str, above: tuple[Path, ...]) -> Path:
        file = self._root / path
        try:
            target = file.resolve(strict=True)
        except (OSError, RuntimeError):
            raise RefusedError("this link leads nowhere", where=ascii_path(path), remedy=_EXCLUDE_IT) from None
        if not target.is_relative_to(self._root):
            raise RefusedError(
                f"this link leads out of the project, to {target}",
                where=ascii_path(path),
                remedy="Copy its target into the project, or exclude it with exclude = [...] "
                "under [tool.pyfrc.deploy] in pyproject.toml.",
            )
        if target in above:
            raise RefusedError(
                "this link leads to a directory that contains it", where=ascii_path(path), remedy=_EXCLUDE_IT
            )
        return target


_EXCLUDE_IT = "Remove it, or exclude it with exclude = [...] under [tool.pyfrc.deploy] in pyproject.toml."


def ascii_path(path: str) -> str:
    """Return a path in a form that every terminal can show."""
    return path if path.isprintable() else ascii(path)


def refuse_unless_utf8(paths: Sequence[str]) -> None:
    """Check that all paths are valid UTF-8.

    :raises RefusedError: with the paths that are not
    """
    bad = [path for path in paths if any("\ud800" <= letter <= "\udfff" for letter in path)]
    if bad:
        raise RefusedError(
            f"names that are not UTF-8 cannot be uploaded: {_listed([ascii(path) for path in bad])}",
            remedy="Rename them, or exclude them with exclude = [...] under [tool.pyfrc.deploy] in pyproject.toml.",
        )


def _refuse_large(sizes: dict[str, int]) -> None:
    if sizes:
        named = _listed([f"{ascii_path(path)} ({size:,} bytes)" for path, size in sizes.items()])
        raise RefusedError(
            f"files over {LARGE:,} bytes, which are usually in a project by mistake: {named}",
            remedy="Upload them with --large, or exclude them with exclude = [...] under [tool.pyfrc.deploy] "
            "in pyproject.toml.",
        )


def listed_paths(paths: Sequence[str]) -> str:
    """Return paths for a message: the first ones, and the number of the others."""
    return _listed([ascii_path(path) for path in paths])


def _listed(names: Sequence[str]) -> str:
    more = len(names) - _MAX_NAMED
    return ", ".join(names[:_MAX_NAMED]) + (f" and {more} more" if more > 0 else "")


def _entry(path: str, file: Path) -> Entry:
    sha256, size = hash_file(file)
    executable = os.name == "posix" and bool(file.stat().st_mode & stat.S_IXUSR)
    return Entry(path, size, sha256, executable, file)
