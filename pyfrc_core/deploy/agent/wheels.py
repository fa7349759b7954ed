"""Unpack wheels. pip on the robot does not know the robot's tags."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from zipfile import ZipFile

from ...wheel_files import WheelFile, files_of, open_wheel
from .activity import Activity
from .disk import BLOCK

_SCRIPT = b"#!python"
#: The beginning of a script, for sh and for Python: it starts with the Python beside it, so it is the same everywhere.
_START = b"#!/bin/sh\n'''exec' \"$(dirname \"$0\")/python3\" \"$0\" \"$@\"\n' '''\n"
#: The modification time of all files: compiled files stay valid when a file is replaced by the same one.
_TIME = 315_532_800


def unpack_wheel(
    wheel: Path, name: str, place: Path, packages: str, activity: Activity, is_wanted: Callable[[str], bool]
) -> dict[str, str]:
    """Unpack a wheel as the specification of wheels says. No file that exists is written to.

    Return the SHA-256 of each of its files by path.

    :param is_wanted: whether it is the wheel from which the file of a path comes; others are only hashed
    :raises WheelError: if it is damaged, or cannot be installed
    """
    with open_wheel(wheel, name) as archive:
        hashes = {
            each.path: _unpack(archive, each, place / each.path if is_wanted(each.path) else None, activity)
            for each in files_of(archive, name, packages)
        }
    activity.step()
    return hashes


def _unpack(archive: ZipFile, file: WheelFile, target: Path | None, activity: Activity) -> str:
    if target is not None:
        target.parent.mkdir(parents=True, exist_ok=True)
    digest = hashlib.sha256()
    with archive.open(file.member) as content, nullcontext() if target is None else target.open("xb") as stream:
        block = content.read(BLOCK)
        if block.startswith(_SCRIPT) and file.path.startswith("bin/"):
            block = _START + block.partition(b"\n")[2]
        while block:
            digest.update(block)
            if stream is not None:
                stream.write(block)
            block = content.read(BLOCK)
            activity.step(0)
    if target is not None:
        target.chmod(0o555 if file.executable else 0o444)
        os.utime(target, (_TIME, _TIME))
    return digest.hexdigest()
