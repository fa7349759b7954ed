"""What is installed, as the packages say of themselves; none of them is imported."""

from __future__ import annotations

import importlib.metadata
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from packaging.requirements import InvalidRequirement, Requirement
from packaging.utils import canonicalize_name
from packaging.version import InvalidVersion, Version

#: What a package needs to be of a WPILib season: one of WPILib's own libraries, in C++.
_WPILIB = {"wpilib", "robotpy-wpiutil", "robotpy-hal", "robotpy-wpimath", "pyntcore", "robotpy-wpinet"}
_NUMBERED_BY_SEASON = re.compile(r"(20)?(2[0-9])\.")


@dataclass(frozen=True)
class Package:
    """An installed distribution.

    :param needs: what it requires here: extras and other platforms' left out
    :param place: the directory that it is installed in
    """

    name: str
    version: str
    needs: tuple[Requirement, ...]
    place: str

    @property
    def season(self) -> int | None:
        """The year that its version says it is for."""
        found = _NUMBERED_BY_SEASON.match(self.version)
        return 2000 + int(found[2]) if found else None

    def __str__(self) -> str:
        return f"{self.name} {self.version}"


@dataclass(frozen=True)
class Unmet:
    """A requirement of a package that is not met.

    :param there: the version that is installed instead; none: it is missing
    """

    package: Package
    needed: Requirement
    there: str | None

    def __str__(self) -> str:
        there = f"not {self.there}" if self.there else "which is missing"
        return f"{self.package} needs {self.needed.name}{self.needed.specifier}, {there}"


class Installed:
    """The distributions that Python finds here, by their canonical names; of several of one name, the first counts."""

    def __init__(self, packages: Iterable[Package]) -> None:
        self.copies: dict[str, list[Package]] = {}
        for package in packages:
            copies = self.copies.setdefault(canonicalize_name(package.name), [])
            # Found twice when its directory is twice on the path.
            if package.place not in {copy.place for copy in copies}:
                copies.append(package)

    def get(self, name: str) -> Package | None:
        copies = self.copies.get(canonicalize_name(name))
        return copies[0] if copies else None

    def unmet(self, package: Package) -> Iterator[Unmet]:
        """What it needs and does not have."""
        for needed in package.needs:
            there = self.get(needed.name)
            if there is None or not fits(there.version, needed):
                yield Unmet(package, needed, there.version if there else None)

    def of_wpilib(self) -> list[Package]:
        """WPILib's own packages, RobotPy's, and what is built upon them, by name."""
        found: set[str] = set()
        before = -1
        while len(found) > before:  # what needs one of them is one of them, too
            before = len(found)
            for name, (package, *_) in self.copies.items():
                if name != "pyfrc" and (
                    name in _WPILIB
                    or name.startswith("robotpy")
                    or any(canonicalize_name(needed.name) in found for needed in package.needs)
                ):
                    found.add(name)
        return [self.copies[name][0] for name in sorted(found)]


def fits(version: str, needed: Requirement) -> bool:
    """Whether this version is one that is asked for."""
    try:
        return needed.specifier.contains(Version(version), prereleases=True)
    except InvalidVersion:
        return True  # nothing can be said


def find_installed() -> Installed:
    """What this Python would import."""
    return Installed(filter(None, map(_package, importlib.metadata.distributions())))


def _package(found: importlib.metadata.Distribution) -> Package | None:
    name = found.metadata["Name"]
    if not name:  # remains of one that was not removed wholly
        return None
    needs = []
    for text in found.requires or ():
        try:
            needed = Requirement(text)
        except InvalidRequirement:
            continue
        if needed.marker is None or needed.marker.evaluate({"extra": ""}):
            needs.append(needed)
    return Package(name, found.version, tuple(needs), str(found.locate_file("")))
