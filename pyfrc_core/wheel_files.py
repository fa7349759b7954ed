"""Which files a wheel installs: checked by `pyfrc sync` before it writes the lock, and once more on the robot.

Only the standard library is imported, since the deploy's agent is sent with this module.
"""

from __future__ import annotations

import os
import re
import stat
import struct
import unicodedata
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

#: What `venv` and the agent make in an environment. On Linux, lib64 is a link to lib there.
_MADE = re.compile(
    r"bin|include|(?:pyvenv\.cfg|environment\.json|\.gitignore|lib64|bin/(?:python|activate)[\d.]*(?:\.\w+)?)(?:/.*)?",
    re.IGNORECASE,
)
_MAX_UNPACKED_BYTES = 1 << 30
_MAX_NAME_BYTES = 255
_ENCRYPTED = 0x1
_DAMAGED = (BadZipFile, EOFError, NotImplementedError, RuntimeError, ValueError, struct.error, zlib.error)


class WheelError(Exception):
    """A wheel that cannot be installed on a robot. The message names it."""


class WheelFile(NamedTuple):
    """A file that a wheel installs.

    :param path:       where, relative to the environment
    :param member:     its entry in the wheel
    :param executable: whether it can be run
    """

    path: str
    member: ZipInfo
    executable: bool


@contextmanager
def open_wheel(file: Path, wheel: str) -> Iterator[ZipFile]:
    """Open a wheel.

    :raises WheelError: if it is damaged, also while it is read
    """
    try:
        with ZipFile(file) as archive:
            yield archive
    except _DAMAGED as error:
        raise WheelError(f"{wheel} is not a wheel: {error}") from error


def files_of(archive: ZipFile, wheel: str, packages: str) -> list[WheelFile]:
    """Return the files that a wheel installs. Console scripts are not made.

    :param wheel:    its name, for messages
    :param packages: the directory of packages, relative to the environment
    :raises WheelError: if it cannot be installed, or has a file in a place that is not for wheels
    """
    found: dict[str, WheelFile] = {}
    for member in archive.infolist():
        if member.is_dir():
            continue
        name, mode = member.filename, member.external_attr >> 16
        path = _path_of(name, wheel, packages)
        if stat.S_IFMT(mode) not in (0, stat.S_IFREG):
            raise WheelError(f"{wheel} has a link, which wheels cannot have: {name!r}")
        if member.flag_bits & _ENCRYPTED or member.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
            raise WheelError(f"{wheel} has a file that robots cannot unpack: {name!r}")
        if _MADE.fullmatch(path) or f"{packages}/".startswith(f"{path}/"):
            raise WheelError(f"{wheel} has a file in the place of Python's own: {name!r}")
        file = WheelFile(path, member, bool(mode & 0o111) or path.startswith("bin/"))
        same = found.setdefault(unicodedata.normalize("NFC", path).casefold(), file)
        if same is not file:
            how = "the same file twice" if same.path == path else "files whose names are the same in lower case"
            raise WheelError(f"{wheel} has {how}: {same.member.filename!r}, {name!r}")
    if (size := sum(each.member.file_size for each in found.values())) > _MAX_UNPACKED_BYTES:
        raise WheelError(f"{wheel} is too large for a robot: {size:,} bytes when it is unpacked")
    return list(found.values())


def owners(wheels: Iterable[tuple[str, Iterable[str]]]) -> dict[str, str]:
    """Return which wheel each file comes from: of several with the same file, the last, as if pip installed them.

    :param wheels: in the lock's order, each with its files
    :raises WheelError: if a file of one is a directory of another
    """
    found = {path: wheel for wheel, paths in wheels for path in paths}
    for path, wheel in found.items():
        above = path
        while above := above.rpartition("/")[0]:
            if above in found:
                raise WheelError(f"{found[above]} has a file where {wheel} has a directory: {above!r}")
    return found


def _path_of(name: str, wheel: str, packages: str) -> str:
    """Return where a member of a wheel belongs, relative to the environment."""
    parts = name.split("/")
    if "\\" in name or "\0" in name or any(part in ("", ".", "..") for part in parts):
        raise WheelError(f"{wheel} has a file that leads out of it: {name!r}")
    if any(len(os.fsencode(part)) > _MAX_NAME_BYTES for part in parts):
        raise WheelError(f"{wheel} has a file whose name is too long: {name!r}")
    if not parts[0].endswith(".data"):
        return f"{packages}/{name}"
    places = {"purelib": packages, "platlib": packages, "scripts": "bin", "data": "", "headers": "include/site"}
    if len(parts) < 3 or parts[1] not in places:
        raise WheelError(f"{wheel} has a file for an unknown place: {name!r}")
    return "/".join(filter(None, (places[parts[1]], *parts[2:])))
