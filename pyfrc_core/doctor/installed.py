"""Installed packages, from their metadata. None of them is imported."""

from __future__ import annotations

import importlib.metadata
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from packaging.requirements import InvalidRequirement, Requirement
from packaging.utils import canonicalize_name

from ..deploy.robot_packages import fits

#: WPILib's own libraries. Packages that require one of them belong to a WPILib season.
_WPILIB = {"wpilib", "robotpy-wpiutil", "robotpy-hal", "robotpy-wpimath", "pyntcore", "robotpy-wpinet"}
_NUMBERED_BY_SEASON = re.compile(r"(20)?(2[0-9])\.")


@dataclass(frozen=True)
class Package:
    """An installed distribution.

    :param needs: its requirements on this platform, without extras
    :param place: the directory where it is installed
    """

    name: str
    version: str
    needs: tuple[Requirement, ...]
    place: str

    @property
    def season(self) -> int | None:
        """Return the year in its version number, or None."""
        found = _NUMBERED_BY_SEASON.match(self.version)
        return 2000 + int(found[2]) if found else None

    def __str__(self) -> str:
        return f"{self.name} {self.version}"


@dataclass(frozen=True)
class Unmet:
    """A requirement of a package that is not met.

    :param there: the installed version; None if the package is missing
    """

    package: Package
    needed: Requirement
    there: str | None

    def __str__(self) -> str:
        there = f"not {self.there}" if self.there else "which is missing"
        return f"{self.package} needs {self.needed.name}{self.needed.specifier}, {there}"


class Installed:
    """The installed distributions by canonical name. Of several copies, Python uses the first."""

    def __init__(self, packages: Iterable[Package]) -> None:
        self.copies: dict[str, list[Package]] = {}
        for package in packages:
            copies = self.copies.setdefault(canonicalize_name(package.name), [])
            # Found twice if its directory is on the path twice.
            if package.place not in {copy.place for copy in copies}:
                copies.append(package)

    def get(self, name: str) -> Package | None:
        copies = self.copies.get(canonicalize_name(name))
        return copies[0] if copies else None

    def unmet(self, package: Package) -> Iterator[Unmet]:
        """Yield the requirements of a package that are not met."""
        for needed in package.needs:
            there = self.get(needed.name)
            if there is None or not fits(there.version, needed):
                yield Unmet(package, needed, there.version if there else None)

    def of_wpilib(self) -> list[Package]:
        """Return the packages of WPILib and RobotPy, and those that depend on them, sorted by name."""
        found: set[str] = set()
        before = -1
        while len(found) > before:  # a package that requires one of them is one of them
            before = len(found)
            for name, (package, *_) in self.copies.items():
                if name != "pyfrc" and (
                    name in _WPILIB
                    or name.startswith("robotpy")
                    or any(canonicalize_name(needed.name) in found for needed in package.needs)
                ):
                    found.add(name)
        return [self.copies[name][0] for name in sorted(found)]


def find_installed() -> Installed:
    """Return the distributions on the path of this Python."""
    return Installed(filter(None, map(_package, importlib.metadata.distributions())))


def _package(found: importlib.metadata.Distribution) -> Package | None:
    about = found.metadata  # parsed each time that a distribution is asked for it, as for its version
    name = about["Name"]
    if not name:  # left over from an incomplete removal
        return None
    needs = []
    for text in about.get_all("Requires-Dist") or ():
        try:
            needed = Requirement(text)
        except InvalidRequirement:
            continue
        if needed.marker is None or needed.marker.evaluate({"extra": ""}):
            needs.append(needed)
    return Package(name, about["Version"], tuple(needs), str(found.locate_file("")))
