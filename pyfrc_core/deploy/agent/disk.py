"""File operations of a deploy: atomic writes, directory walks, removal, hard links, free space."""

from __future__ import annotations

import errno
import hashlib
import os
import stat
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path

from .activity import Activity
from .system import flush, link_file, linked_directory, user

BLOCK = 1 << 16


def write_whole(file: Path, text: str, mode: int = 0o644, between: Path | None = None) -> None:
    """Write a file atomically: after a power cut it has the old or the new content.

    :param between: its name until it takes its place; default: one beside it
    """
    beside = between or file.with_name(f".{file.name}.new")
    with beside.open("w", encoding="utf-8", errors="surrogateescape") as stream:
        stream.write(text)
        stream.flush()
        os.fsync(stream.fileno())
    beside.chmod(mode)
    beside.replace(file)


def sync(directory: Path, activity: Activity) -> None:
    """Wait until all data written to this file system is on the disk."""
    activity.begin("sync")
    activity.wait_for(flush, directory)


def text_of(file: Path) -> str | None:
    """Return the content of a text file, or None if it cannot be read."""
    try:
        return file.read_text(encoding="utf-8", errors="surrogateescape")
    except OSError:
        return None


def everything_below(directory: Path) -> Iterator[tuple[str, os.DirEntry[str]]]:
    """Yield the relative path and entry of each file, link and directory below a directory.

    ``__pycache__`` directories are skipped. A directory comes before its content.
    """
    waiting = [("", str(directory))]
    while waiting:
        prefix, above = waiting.pop()
        inner = []
        for entry in _entries(above):
            name = prefix + entry.name
            if entry.is_dir(follow_symlinks=False):
                if entry.name == "__pycache__":
                    continue
                inner.append((f"{name}/", entry.path))
            yield name, entry
        waiting += reversed(inner)


def _entries(directory: str) -> list[os.DirEntry[str]]:
    try:
        with os.scandir(directory) as entries:
            return sorted(entries, key=lambda entry: entry.name)
    except OSError:
        return []  # removed by the program meanwhile, or not readable for this user


def files_below(directory: Path) -> Iterator[tuple[str, os.DirEntry[str]]]:
    """Yield the regular files among `everything_below`."""
    return ((name, entry) for name, entry in everything_below(directory) if entry.is_file(follow_symlinks=False))


def remove(path: Path) -> None:
    """Remove a file or a directory tree, if it exists.

    :raises OSError: with the full path of an entry that cannot be removed
    """
    if _is_directory(path):
        remove_if_possible(path)
    while os.path.lexists(path):
        inside = path
        while _is_directory(inside) and (entries := sorted(inside.iterdir())):
            inside = entries[0]
        with suppress(FileNotFoundError):
            inside.rmdir() if _is_directory(inside) else inside.unlink()


def remove_if_possible(path: Path) -> None:
    """Remove a directory tree, except for entries that belong to other users of the robot."""
    import shutil

    shutil.rmtree(path, ignore_errors=True)
    if path.exists():
        allow_changes(path)
        for above, names, _ in os.walk(path):
            for name in names:
                allow_changes(Path(above, name))
        shutil.rmtree(path, ignore_errors=True)


def allow_changes(path: Path) -> None:
    """Let this user change an own directory, which the program may have made read-only."""
    if _is_directory(path):
        with suppress(OSError):  # it belongs to another user
            path.chmod(0o755)


def _is_directory(path: Path) -> bool:
    return path.is_dir() and linked_directory(path) is None


def sha256_of(file: str, activity: Activity) -> str:
    """Return the SHA-256 of a file's content in hexadecimal."""
    digest = hashlib.sha256()
    descriptor = os.open(file, os.O_RDONLY)
    try:
        while block := os.read(descriptor, BLOCK):
            digest.update(block)
            activity.step(0)
    finally:
        os.close(descriptor)
    return digest.hexdigest()


def fingerprint(file: str, activity: Activity) -> str:
    """Return the SHA-256 of a file's content, or a link's target."""
    if os.path.islink(file):  # noqa: PTH114 - thousands of files
        return f"-> {os.readlink(file)}"  # noqa: PTH115
    return sha256_of(file, activity)


def different_files(
    directory: Path, hashes: Mapping[str, str], activity: Activity, known: dict[tuple[int, int], str]
) -> list[str]:
    """Return the files below a directory that are missing, or whose content differs.

    :param hashes: the fingerprint of each file by its path
    :param known:  fingerprints by device and inode, so that a file of several directories is read once; is extended
    """
    found = []
    for path, wanted in hashes.items():
        activity.step()
        file = f"{directory}/{path}"
        try:
            state = os.lstat(file)
            identity = (state.st_dev, state.st_ino)
            if identity not in known:
                known[identity] = fingerprint(file, activity)
            if known[identity] == wanted:
                continue
        except OSError:
            pass  # missing, or unreadable
        found.append(path)
    return found


def replace_by_link(source: Path, target: Path) -> None:
    """Replace a file, which may be a link to a file of other directories, by a link to another one."""
    beside = target.with_name(f".{target.name}.new")
    remove(beside)
    target.parent.mkdir(parents=True, exist_ok=True)
    link_or_copy(str(source), str(beside))
    beside.replace(target)


class SpecialFileError(OSError):
    """A file cannot be copied, since it is a pipe, a socket or a device."""


def link_or_copy(source: str, target: str) -> None:
    """Create `target` as a hard link to `source`, or as a copy if hard links are not supported.

    :raises SpecialFileError: if it can be neither linked nor copied
    """
    try:
        link_file(source, target)
    except FileNotFoundError:
        raise
    except OSError as error:
        mode = os.lstat(source).st_mode
        if not (stat.S_ISREG(mode) or stat.S_ISLNK(mode)):
            raise SpecialFileError(errno.EINVAL, "it is a pipe, a socket or a device", source) from error
        import shutil

        shutil.copy2(source, target, follow_symlinks=False)


def disk_problem(error: OSError, by_administrator: str) -> tuple[str, str]:
    """Return what is wrong with the robot's disk, and what the user can do.

    :param by_administrator: where a user types a command for the administrator
    """
    if error.errno == errno.EROFS:
        remedy = "Switch the robot off and on again; if that does not help, image it."
        return "the robot's disk cannot be written: it is read-only, as after an error", remedy
    names = [Path(os.fsdecode(each)) for each in (error.filename, error.filename2) if isinstance(each, (str, bytes))]
    for name in names if error.errno in (errno.EACCES, errno.EPERM) else ():
        there = next((each for each in (name, *name.parents) if each.exists() and not each.is_symlink()), name)
        if not os.access(there, os.W_OK):
            remedy = f"Give it to {user()}, {by_administrator} chown -R {user()} {there}"
            return f"{there} on the robot belongs to another user, and {user()} cannot write to it", remedy
    what = error.strerror or str(error) or type(error).__name__
    is_taken = error.errno in (errno.EEXIST, errno.EISDIR, errno.ENOTDIR, errno.ENOTEMPTY)
    remedy = "Remove or rename it on the robot." if is_taken else "Check its owner and permissions."
    return f"{names[-1] if names else 'the robot'}: {what}", remedy


def make_links_absolute(directory: Path, between: Path) -> None:
    """Make relative links that lead out of a directory absolute, so that they stay valid when it is moved.

    :param between: the name of each new link until it takes its place
    """
    between.parent.mkdir(parents=True, exist_ok=True)
    for _, entry in everything_below(directory):
        with suppress(OSError):  # it belongs to another user
            if entry.is_symlink() and not (target := Path(entry.path).readlink()).is_absolute():
                absolute = Path(os.path.normpath(Path(entry.path).parent / target))
                if directory not in (absolute, *absolute.parents):
                    remove(between)
                    between.symlink_to(absolute)
                    between.replace(entry.path)


def free_bytes(directory: Path) -> int:
    """Return the free space of this file system, in bytes."""
    if sys.platform != "win32":
        state = os.statvfs(directory)
        return state.f_bavail * state.f_frsize
    import shutil

    return shutil.disk_usage(directory).free
