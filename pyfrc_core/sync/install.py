"""Install the packages of a lock on this computer, too: what runs here is then what runs on the robot."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from importlib import metadata
from pathlib import Path

from .._version import __version__
from ..errors import PyfrcError
from ..season import Season
from ..temporary import temporary_directory
from .lock import Lock


def different_here(lock: Lock) -> Iterator[str]:
    """Yield each package that this computer has in another version than the lock."""
    for each in lock.packages:
        here = _version_here(each.name)
        if here not in (None, each.version):
            yield f"{each.name} {here} (the robot: {each.version})"


def missing_here(lock: Lock, season: Season) -> Iterator[str]:
    """Yield each package that the project itself asks for, also on this computer, and that this computer lacks.

    Without the package that only needs all of WPILib.
    """
    from packaging.requirements import Requirement
    from packaging.utils import canonicalize_name

    for needed in map(Requirement, lock.requirements):
        name = canonicalize_name(needed.name)
        for_here = needed.marker is None or needed.marker.evaluate({"extra": ""})
        if for_here and name != season.downloads.packages and _version_here(name) is None:
            yield name


def _version_here(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def install_here(lock: Lock, season: Season, find_links: Sequence[str], quiet: bool = False) -> None:
    """Install what the lock is for, in the locked versions. pip prints what it does.

    Packages that only a robot needs are not installed, and those that only a computer needs are.

    :raises PyfrcError: if pip cannot
    """
    requirements = [_with_version(each, lock, season) for each in lock.requirements]
    if not requirements:
        return
    with temporary_directory("sync") as temporary:
        constraints = Path(temporary, "constraints.txt")
        versions = {each.name: each.version for each in lock.packages} | {"pyfrc": __version__}
        constraints.write_text("".join(f"{name}=={version}\n" for name, version in versions.items()), "utf-8")
        command = [sys.executable, "-m", "pip", "install", "--disable-pip-version-check", *(["--quiet"] * quiet)]
        command += [part for place in find_links for part in ("--find-links", place)]
        done = subprocess.run([*command, "--constraint", str(constraints), *requirements], stdin=subprocess.DEVNULL)
    if done.returncode:
        raise PyfrcError(
            "pip could not install the robot's versions on this computer; its reason is above",
            remedy="What the robot needs is complete. A newer Python may have these packages: the robot has "
            f"{'.'.join(map(str, season.controller.python))}.",
        )


def _with_version(requirement: str, lock: Lock, season: Season) -> str:
    """Return a requirement for WPILib's packages with the locked version: pip takes a preview only if it is named."""
    name = season.downloads.packages
    version = next((each.version for each in lock.packages if each.name == name), None)
    is_it = requirement == name or requirement.startswith(f"{name}[")
    return f"{requirement}=={version}" if is_it and version is not None and "=" not in requirement else requirement
