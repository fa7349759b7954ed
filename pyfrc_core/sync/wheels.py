"""Check that a robot can install the wheels of a lock, before it is written."""

from __future__ import annotations

from collections.abc import Iterator
from zipfile import ZipInfo

from ..errors import PyfrcError
from ..season import Season
from ..wheel_files import WheelError, files_of, open_wheel, owners
from .cache import Cache
from .lock import Lock

_REMEDY = "A robot cannot have it: take another version, or leave it out of [tool.robotpy]; its authors can correct it."


def check_wheels(lock: Lock, season: Season, cache: Cache) -> Iterator[str]:
    """Check all wheels of a lock. Yield a sentence for wheels that have a file of the same name, and differ in it.

    :raises PyfrcError: if one cannot be installed, or two cannot be installed together
    """
    packages = f"lib/python{'.'.join(map(str, season.controller.python))}/site-packages"
    files: dict[str, dict[str, ZipInfo]] = {}
    try:
        for each in lock.packages:
            with open_wheel(cache.path_of(each), each.file) as archive:
                files[each.file] = {file.path: file.member for file in files_of(archive, each.file, packages)}
        owner = owners(files.items())
    except WheelError as wrong:
        raise PyfrcError(str(wrong), remedy=_REMEDY) from None
    names = {each.file: str(each) for each in lock.packages}
    for file, members in files.items():
        lost = [path for path, member in members.items() if files[owner[path]][path].CRC != member.CRC]
        for last in sorted({owner[path] for path in lost}):
            first, *others = [path.removeprefix(f"{packages}/") for path in lost if owner[path] == last]
            more = f" and {len(others)} more" if others else ""
            yield f"{names[file]} and {names[last]} both have {first}{more}: the robot gets that of {names[last]}"
