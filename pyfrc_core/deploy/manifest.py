"""The project's files to deploy, with their sizes and hashes; those that seem private, and those that are excluded."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

from ..file_hash import hash_file
from ..log_formats import FOREIGN_LOGS, ROBOT_LOGS
from ..project.environments import is_environment
from ..sync.lock import LOCK_FILE
from .errors import RefusedError


def matches(path: str, pattern: str) -> bool:
    """Return whether a path (relative, with forward slashes) matches a pattern.

    A pattern without a slash matches the name of a file or directory at any depth. A pattern with a slash matches the
    whole path; ``**`` matches any number of directories.
    """
    parts, wanted = path.split("/"), pattern.strip("/").split("/")
    if "/" in pattern.rstrip("/"):
        return _parts_fit(parts, wanted)
    return len(wanted) == 1 and fnmatchcase(parts[-1], wanted[0])


def _parts_fit(parts: Sequence[str], wanted: Sequence[str]) -> bool:
    if not wanted:
        return not parts
    if wanted[0] == "**":
        return any(_parts_fit(parts[skipped:], wanted[1:]) for skipped in range(len(parts) + 1))
    return bool(parts) and fnmatchcase(parts[0], wanted[0]) and _parts_fit(parts[1:], wanted[1:])


#: Names of files that hold keys or passwords.
_KEY_FILE = re.compile(r"id_(?:rsa|dsa|ecdsa|ed25519)(?:_sk)?|.+\.(?:env|key|pem|ppk|p12|pfx|jks|kdbx)", re.IGNORECASE)

#: Other tools exclude these as well.
_DIRECTORIES_LEFT_OUT = {"__pycache__", "venv", "ctre_sim"}
_SUFFIXES_LEFT_OUT = (".pyc", ".whl", ".ipk", ".zip", ".gz", *ROBOT_LOGS, *FOREIGN_LOGS)
#: Each deploy writes the first on the robot: in a project it can only be a copy. The other is for this computer.
_FILES_LEFT_OUT = {"deploy.json", LOCK_FILE}

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
    """All files of a program, sorted by path.

    :param private: the paths that are probably not meant to be uploaded, each with the reason
    """

    entries: tuple[Entry, ...]
    private: Mapping[str, str] = field(default_factory=dict)

    @property
    def total_bytes(self) -> int:
        return sum(entry.size for entry in self.entries)


def build_manifest(root: Path, exclude: Sequence[str] = (), large: bool = False, meant: Sequence[str] = ()) -> Manifest:
    """Return the files to upload from the program's directory.

    :param exclude: patterns of excluded files, from ``[tool.pyfrc.deploy] exclude``
    :param large: whether to upload files over 250,000 bytes
    :param meant: patterns of files that are not private, from ``[tool.pyfrc.deploy] private``
    :raises RefusedError: with the files that cannot be uploaded
    """
    with _naming_unreadable_files(root):
        walk = _Walk(root.resolve(), exclude)
        found = sorted(walk.files())
        refuse_unless_utf8([path for path, _ in found])
        sizes = {path: file.stat().st_size for path, file in found}
        if not large:
            _refuse_large({path: size for path, size in sizes.items() if size > LARGE})
        private = {path: why for path, why in sorted(walk.private.items()) if not is_excluded(path, meant)}
        return Manifest(tuple(_entry(path, file) for path, file in found), private)


@contextmanager
def _naming_unreadable_files(root: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise RefusedError(
            f"this cannot be read: {error.strerror or error}",
            where=ascii_path(str(error.filename or root)),
            remedy="Check its owner and permissions, or exclude it with exclude = [...] under [tool.pyfrc.deploy] "
            "in pyproject.toml.",
        ) from error


def is_excluded(path: str, patterns: Sequence[str]) -> bool:
    """Return whether a path (relative, with forward slashes) matches one of the patterns; see `patterns`."""
    return any(matches(path, pattern) for pattern in patterns)


class _Walk:
    """A walk through a project's directories that follows links within the project."""

    def __init__(self, root: Path, exclude: Sequence[str]) -> None:
        self._root = root
        self._exclude = exclude
        #: Paths of files that are probably not meant to be uploaded, each with the reason.
        self.private: dict[str, str] = {}

    def files(self) -> Iterator[tuple[str, Path]]:
        if is_environment(self._root) and not is_excluded("pyvenv.cfg", self._exclude):
            raise RefusedError(
                "the project's directory is itself a virtual environment, whose packages would be uploaded",
                where=self._root,
                remedy="Create it in a directory of its own: python -m venv .venv. Then remove pyvenv.cfg, bin, "
                "include and lib here.",
            )
        yield from self._within(self._root, "", (self._root,))

    def _within(self, directory: Path, prefix: str, above: tuple[Path, ...]) -> Iterator[tuple[str, Path]]:
        for item in list(os.scandir(directory)):  # read at once, and closed
            path = prefix + item.name
            if item.name.startswith(".") or path in _FILES_LEFT_OUT or is_excluded(path, self._exclude):
                continue
            # Checked before the link target: an excluded link may lead outside of the project.
            is_directory = Path(item.path).is_dir()
            if item.name in _DIRECTORIES_LEFT_OUT if is_directory else item.name.endswith(_SUFFIXES_LEFT_OUT):
                continue
            file = self._link_target(path, above) if item.is_symlink() else Path(item.path)
            if is_directory:
                if not is_environment(file):
                    yield from self._within(file, f"{path}/", (*above, file))
            elif stat.S_ISREG(file.stat().st_mode):
                if why := self._why_private(path, file):
                    self.private[path] = why
                yield path, file
            else:
                raise RefusedError(
                    "this is a device, a pipe or a socket, which cannot be uploaded",
                    where=ascii_path(path),
                    remedy=_EXCLUDE_IT,
                )

    def _why_private(self, path: str, file: Path) -> str:
        target = file.relative_to(self._root).as_posix()
        parts = target.split("/")
        above = ["/".join(parts[:count]) for count in range(1, len(parts) + 1)]
        if any(each.startswith(".") for each in parts) or any(is_excluded(each, self._exclude) for each in above):
            return f"leads to {ascii_path(target)}, which is not uploaded itself"
        if _KEY_FILE.fullmatch(file.name) or _KEY_FILE.fullmatch(path.rpartition("/")[2]):
            return "files of this name hold keys or passwords"
        return ""

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
            f"names that are not UTF-8 cannot be uploaded: {listed([ascii(path) for path in bad])}",
            remedy="Rename them, or exclude them with exclude = [...] under [tool.pyfrc.deploy] in pyproject.toml.",
        )


def _refuse_large(sizes: dict[str, int]) -> None:
    if sizes:
        named = listed([f"{ascii_path(path)} ({size:,} bytes)" for path, size in sizes.items()])
        raise RefusedError(
            f"files over {LARGE:,} bytes, which are usually in a project by mistake: {named}",
            remedy="Upload them with --large, or exclude them with exclude = [...] under [tool.pyfrc.deploy] "
            "in pyproject.toml.",
        )


def listed_paths(paths: Sequence[str]) -> str:
    """Return paths for a message; see `listed`."""
    return listed([ascii_path(path) for path in paths])


def listed(names: Sequence[str]) -> str:
    """Return the first names, and the number of the others."""
    more = len(names) - _MAX_NAMED
    return ", ".join(names[:_MAX_NAMED]) + (f" and {more} more" if more > 0 else "")


def _entry(path: str, file: Path) -> Entry:
    sha256, size = hash_file(file)
    executable = os.name == "posix" and bool(file.stat().st_mode & stat.S_IXUSR)
    return Entry(path, size, sha256, executable, file)
