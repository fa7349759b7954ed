"""Write files atomically."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from tempfile import NamedTemporaryFile


def write_whole(file: Path, text: Iterable[str]) -> None:
    """Write `text` to `file` by way of a temporary file beside it; create its directory if necessary."""
    file.parent.mkdir(parents=True, exist_ok=True)
    try:
        _write_beside(file, text)
    except OSError as error:
        error.filename = str(file)  # the one that was asked for, not the temporary one
        raise


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
