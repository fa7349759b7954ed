"""Which of the project's files belong on the robot, and what is in them."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from .errors import RefusedError

#: What the other tools leave out, too.
_DIRECTORIES_LEFT_OUT = {"__pycache__", "venv", "ctre_sim"}
_SUFFIXES_LEFT_OUT = (".pyc", ".whl", ".ipk", ".zip", ".gz", ".wpilog")
#: Written on the robot by each deploy; in a project it can only be one that was copied from there.
_WRITTEN_BY_DEPLOYS = "deploy.json"

#: Larger files, in bytes, are uploaded only with the user's word: they are mostly there by mistake.
LARGE = 250_000

_MOST_NAMED = 10


@dataclass(frozen=True)
class Entry:
    """One file to be on the robot.

    :param path: relative to the code's directory, with forward slashes
    :param size: in bytes
    :param sha256: of its content, in hexadecimal
    :param file: where it is here
    """

    path: str
    size: int
    sha256: str
    executable: bool
    file: Path


@dataclass(frozen=True)
class Manifest:
    """All the files of a program, in the order of their paths."""

    entries: tuple[Entry, ...]

    @property
    def total_bytes(self) -> int:
        return sum(entry.size for entry in self.entries)


def survey(root: Path, exclude: Sequence[str] = (), large: bool = False) -> Manifest:
    """What is to be uploaded of the program in the directory `root`.

    :param exclude: patterns of what is left out, as ``[tool.pyfrc.deploy] exclude`` has them
    :param large: whether files over 250,000 bytes are meant to be uploaded
    :raises RefusedError: naming the files that cannot be uploaded
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
            remedy="Look at its owner and mode, or leave it out with exclude = [...] under [tool.pyfrc.deploy] "
            "in pyproject.toml.",
        ) from error


def is_excluded(path: str, patterns: Sequence[str]) -> bool:
    """Whether a path (relative, with forward slashes) fits one of the patterns.

    A pattern without a slash is about the name of a file or directory, wherever it is; one with a slash is about the
    path from the top, where ``**`` stands for any number of directories.
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
    """The way through a project's directories, links followed as far as they stay inside."""

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
            # A directory or file that is left out may be a link to anywhere.
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
                    "this is no file that can be uploaded, but a device, a pipe or a socket",
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
                remedy="Copy what it leads to into the project, or leave it out with exclude = [...] "
                "under [tool.pyfrc.deploy] in pyproject.toml.",
            )
        if target in above:
            raise RefusedError(
                "this link leads to a directory that it is in", where=ascii_path(path), remedy=_EXCLUDE_IT
            )
        return target


_EXCLUDE_IT = "Remove it, or leave it out with exclude = [...] under [tool.pyfrc.deploy] in pyproject.toml."


def ascii_path(path: str) -> str:
    """A path that a terminal can show, whatever is in it."""
    return path if path.isprintable() else ascii(path)


def refuse_unless_utf8(paths: Sequence[str]) -> None:
    """:raises RefusedError: naming the paths that cannot be told to the robot"""
    bad = [path for path in paths if any("\ud800" <= letter <= "\udfff" for letter in path)]
    if bad:
        raise RefusedError(
            f"names that are not UTF-8 cannot be uploaded: {_listed([ascii(path) for path in bad])}",
            remedy="Rename them, or leave them out with exclude = [...] under [tool.pyfrc.deploy] in pyproject.toml.",
        )


def _refuse_large(sizes: dict[str, int]) -> None:
    if sizes:
        named = _listed([f"{ascii_path(path)} ({size:,} bytes)" for path, size in sizes.items()])
        raise RefusedError(
            f"files over {LARGE:,} bytes, which are mostly there by mistake: {named}",
            remedy="Upload them with --large, or leave them out with exclude = [...] under [tool.pyfrc.deploy] "
            "in pyproject.toml.",
        )


def _listed(names: Sequence[str]) -> str:
    more = len(names) - _MOST_NAMED
    return ", ".join(names[:_MOST_NAMED]) + (f" and {more} more" if more > 0 else "")


def _entry(path: str, file: Path) -> Entry:
    content = file.read_bytes()
    executable = os.name == "posix" and bool(file.stat().st_mode & stat.S_IXUSR)
    return Entry(path, len(content), hashlib.sha256(content).hexdigest(), executable, file)
