"""Write files atomically, and check in advance that they can be written."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from tempfile import NamedTemporaryFile, TemporaryFile

from .errors import UsageError


def write_whole(file: Path, text: Iterable[str]) -> None:
    """Write `text` to `file` by way of a temporary file beside it; create its directory if necessary."""
    file.parent.mkdir(parents=True, exist_ok=True)
    try:
        _write_beside(file, text)
    except OSError as error:
        error.filename = str(file)  # the one that was asked for, not the temporary one
        raise


def check_writable(option: str, path: Path, is_directory: bool = False) -> None:
    """Check that a file can be written; create its directory. Long work must not be lost at its end.

    :param option: the option that names the file
    :param is_directory: whether it names a directory, in which a file can be written then
    :raises UsageError: when it cannot
    """
    file = path / "any" if is_directory else path
    try:
        if (taken := next((each for each in file.parents if each.is_file()), None)) is not None:
            raise NotADirectoryError(0, f"{taken} is a file")
        file.parent.mkdir(parents=True, exist_ok=True)
        if file.is_dir():
            raise IsADirectoryError(0, "it is a directory")
        if file.exists() and not os.access(file, os.W_OK):
            raise PermissionError(0, "it is read-only")
        with TemporaryFile(dir=file.parent, prefix=f".{file.name}-"):
            pass
    except OSError as error:
        raise cannot_write(option, path, error.strerror) from None


def cannot_write(option: str, file: Path, why: str | None) -> UsageError:
    """Return the error for a file that an option names."""
    return UsageError(f"{option} {file} cannot be written: {why}", remedy="Choose another place.")


def keep_out_of_version_control(directory: Path) -> None:
    """Have Git ignore a directory of pyfrc's in a robot project."""
    ignored = directory / ".gitignore"
    if not ignored.exists():
        write_whole(ignored, ["*\n"])


def _write_beside(file: Path, text: Iterable[str]) -> None:
    with NamedTemporaryFile("w", encoding="utf-8", dir=file.parent, prefix=f".{file.name}-", delete=False) as beside:
        try:
            beside.writelines(text)
            beside.close()
            Path(beside.name).chmod(0o666 & ~_umask())  # temporary files are made for their owner alone
            Path(beside.name).replace(file)
        except BaseException:
            Path(beside.name).unlink(missing_ok=True)
            raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
