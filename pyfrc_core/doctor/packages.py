"""Whether what is installed fits together: Python, pyfrc itself, WPILib and vendors' packages of one season."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import platform
import struct
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from packaging.utils import canonicalize_name

from .._version import __version__, requirement
from ..season import CURRENT
from .findings import Finding, hint, ok, problem
from .installed import Installed, Package, Unmet

#: The newest Python that pyfrc's classifiers name.
NEWEST = (3, 14)
OLDEST = (3, 10)

#: The directory with the packages of the pyfrc that runs.
CODE = Path(__file__).resolve().parents[2]


def examine_python(
    version: tuple[int, int] = sys.version_info[:2], bits: int = 8 * struct.calcsize("P")
) -> Iterator[Finding]:
    """Whether it is a Python that pyfrc and WPILib run on."""
    what = f"{platform.python_version()}, {bits} bits, {sys.executable}"
    name = ".".join(map(str, version))
    if version < OLDEST:
        yield problem(
            "Python", f"{name} is too old", "Install Python 3.10 or newer, and make a new environment with it."
        )
    elif bits < 64:
        yield problem("Python", f"{what}: WPILib has 64 bits only", "Install the 64-bit Python of your system.")
    elif version > NEWEST:
        newest = ".".join(map(str, NEWEST))
        yield hint("Python", f"{name} is newer than pyfrc knows", f"If something fails, try Python {newest}.")
    else:
        yield ok("Python", what)


def examine_pyfrc(installed: Installed) -> Iterator[Finding]:
    """Whether pyfrc is there once, with all it needs, and nothing else under its names."""
    copies = installed.copies.get("pyfrc", [])
    if not copies:
        yield hint("pyfrc", f"{__version__} runs from {CODE} without being installed", f"pip install -e {CODE}")
        return
    problems = list(_mixed_up(copies))
    for unmet in installed.unmet(copies[0]):
        problems.append(problem("pyfrc", str(unmet), f'pip install "{unmet.needed.name}{unmet.needed.specifier}"'))
    yield from problems or [ok("pyfrc", f"{__version__}, {CODE}")]


def _mixed_up(copies: Sequence[Package]) -> Iterator[Finding]:
    """Where another pyfrc, or something like it, is in this one's place."""
    anew = f'pip uninstall pyfrc, as often as it finds one; then pip install "{requirement()}"'
    if len(copies) > 1:
        places = ", ".join(f"{copy.version} in {copy.place}" for copy in copies)
        yield problem("pyfrc", f"installed {len(copies)} times: {places}", anew)
    elif copies[0].version != __version__:
        there = f"{copies[0].version} is installed, in {copies[0].place}"
        yield problem("pyfrc", f"{__version__} runs, from {CODE}, but {there}", anew)
    named = importlib.util.find_spec("pyfrc")
    if named is None or named.origin is None or Path(named.origin).resolve().parents[1] != CODE:
        where = named.origin if named else "nowhere"
        yield problem("pyfrc", f"import pyfrc finds another one: {where}", f"Rename that if it is yours; else: {anew}")
    ours = {"test", "sim", "coverage", "profiler", "create-physics", "add-tests"}
    for command in importlib.metadata.entry_points(group=CURRENT.cli_plugins):
        if command.name in ours and not command.value.startswith("pyfrc_cli.") and command.dist is not None:
            other = command.dist.metadata["Name"]
            text = f"robotpy {command.name} is {other}'s as well as pyfrc's"
            yield hint("pyfrc", text, f"Use pyfrc {command.name}, or: pip uninstall {other}")


def examine_wpilib(installed: Installed) -> Iterator[Finding]:
    """Whether WPILib's packages, and those built upon them, have what they need and are of one season."""
    wpilib = installed.get("wpilib")
    if wpilib is None:
        yield problem("wpilib", "not installed", "pip install wpilib")
        return
    family = installed.of_wpilib()
    problems = [*_unmet(installed, family, wpilib), *_other_seasons(family, wpilib)]
    told = [str(package) for package in family if not _part_of_wpilib(package, wpilib)]
    beside = f"; with {', '.join(told)}" if told else ""
    fine = ok("wpilib", f"{wpilib.version}, and its {len(family) - len(told) - 1} companions fit{beside}")
    yield from problems or [fine]


def _unmet(installed: Installed, family: Sequence[Package], wpilib: Package) -> Iterator[Finding]:
    """What they need and do not have, each thing once."""
    every = [unmet for package in family for unmet in installed.unmet(package)]
    # What WPILib needs in another version will be replaced: what that one needs is of no account.
    odd = {canonicalize_name(unmet.needed.name) for unmet in every if unmet.package.version == wpilib.version}
    told: dict[str, list[Unmet]] = {}
    for unmet in every:
        if canonicalize_name(unmet.package.name) in odd:
            continue
        needed = f'"{unmet.needed.name}{unmet.needed.specifier}"'
        # Where it is as WPILib is, the one that asks is of another time.
        stays = unmet.there == wpilib.version
        remedy = f"pip install --upgrade {unmet.package.name}" if stays else f"pip install {needed}"
        told.setdefault(remedy, []).append(unmet)
    for remedy, (first, *others) in told.items():
        also = f"; needed by {', '.join(str(each.package) for each in others)}, too" if others else ""
        yield problem("wpilib", f"{first}{also}", remedy)


def _other_seasons(family: Sequence[Package], wpilib: Package) -> Iterator[Finding]:
    for package in family:
        if None not in (package.season, wpilib.season) and package.season != wpilib.season:
            yield problem(
                "wpilib",
                f"{package} is for the season {package.season}, {wpilib} for {wpilib.season}",
                f'pip install --upgrade "{package.name}=={_of_season(package, wpilib)}"',
            )


def _of_season(package: Package, wpilib: Package) -> str:
    """The version to install, numbered as that package numbers its own."""
    four_digits = len(package.version.partition(".")[0]) == 4
    return f"{wpilib.season if four_digits else str(wpilib.season)[2:]}.*"


def _part_of_wpilib(package: Package, wpilib: Package) -> bool:
    return package.name.startswith("robotpy-native-") or package == wpilib or package.version == wpilib.version
