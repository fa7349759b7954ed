"""Checks that Python, pyfrc, WPILib and vendors' packages are compatible and of the same season.

Installed libraries are imported in a separate process, since they may crash.
"""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import platform
import struct
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from .._version import __version__, requirement
from ..config.packages import PACKAGES, quoted_requirement
from ..errors import ProjectError
from ..processes.crashes import crash_of
from ..processes.spawn import WRITES_UTF_8
from ..season import CURRENT, Season, SeasonSetting, refuse_unknown_wpilib
from .check_result import CheckResult, hint, ok, problem
from .installed import Installed, Package, Unmet

#: The newest Python version in pyfrc's classifiers.
NEWEST = (3, 14)
OLDEST = (3, 10)

#: The directory of the running pyfrc.
CODE = Path(__file__).resolve().parents[2]


def check_python(
    version: tuple[int, int] = sys.version_info[:2], bits: int = 8 * struct.calcsize("P")
) -> Iterator[CheckResult]:
    """Check whether pyfrc and WPILib support this Python."""
    what = f"{platform.python_version()}, {bits} bits, {sys.executable}"
    name = ".".join(map(str, version))
    if version < OLDEST:
        yield problem(
            "Python", f"{name} is too old", "Install Python 3.10 or newer, and create a new environment with it."
        )
    elif bits < 64:
        yield problem("Python", f"{what}: WPILib needs 64 bits", "Install the 64-bit Python of your system.")
    elif version > NEWEST:
        newest = ".".join(map(str, NEWEST))
        yield hint(
            "Python",
            f"{name} is newer than the tested versions",
            f"If something fails, try Python {newest}.",
        )
    else:
        yield ok("Python", what)


def check_pyfrc(installed: Installed, season: Season = CURRENT) -> Iterator[CheckResult]:
    """Check that pyfrc is installed once, with its requirements, and without conflicting names.

    :param season: whose WPILib is to be installed, where it is not
    """
    copies = installed.copies.get("pyfrc", [])
    if not copies:
        yield hint("pyfrc", f"{__version__} runs from {CODE} without being installed", f'pip install -e "{CODE}"')
        return
    problems = list(_mixed_up(copies))
    for unmet in installed.unmet(copies[0]):
        if unmet.needed.name == "wpilib":  # pyfrc's own requirement fits each season
            unmet = replace(unmet, needed=Requirement(season.requirement))
        problems.append(problem("pyfrc", str(unmet), f"pip install {quoted_requirement(unmet.needed)}"))
    yield from problems or [ok("pyfrc", f"{__version__}, {CODE}")]


def _mixed_up(copies: Sequence[Package]) -> Iterator[CheckResult]:
    """Find other copies of pyfrc, and packages with the same names."""
    reinstall = f'pip uninstall pyfrc, until it finds none; then pip install "{requirement()}"'
    if len(copies) > 1:
        places = ", ".join(f"{copy.version} in {copy.place}" for copy in copies)
        yield problem("pyfrc", f"installed {len(copies)} times: {places}", reinstall)
    elif copies[0].version != __version__:
        there = f"{copies[0].version} is installed, in {copies[0].place}"
        yield problem("pyfrc", f"{__version__} runs, from {CODE}, but {there}", reinstall)
    named = importlib.util.find_spec("pyfrc")
    if named is None or named.origin is None or Path(named.origin).resolve().parents[1] != CODE:
        where = named.origin if named else "nowhere"
        yield problem(
            "pyfrc", f"import pyfrc finds another one: {where}", f"Rename it if it is yours; else: {reinstall}"
        )
    commands = importlib.metadata.entry_points(group=CURRENT.cli_plugins)
    ours = {command.name for command in commands if command.value.startswith("pyfrc_cli.")}
    for command in commands:
        if command.name in ours and not command.value.startswith("pyfrc_cli.") and command.dist is not None:
            other = command.dist.metadata["Name"]
            text = f"both {other} and pyfrc provide robotpy {command.name}"
            yield hint("pyfrc", text, f"Use pyfrc {command.name}, or: pip uninstall {other}")


def check_wpilib(installed: Installed, settings: Sequence[SeasonSetting] = ()) -> Iterator[CheckResult]:
    """Check that the packages of WPILib and those that depend on it are compatible and of the same season.

    :param settings: the project's settings that fit one season
    """
    wpilib = installed.get("wpilib")
    try:
        refuse_unknown_wpilib(wpilib.version if wpilib else None, settings)
    except ProjectError as unknown:
        yield problem("wpilib", unknown.message, unknown.remedy or "")
    if wpilib is None:
        return
    family = installed.of_wpilib()
    problems = [*_unmet(installed, family, wpilib), *_other_seasons(family, wpilib)]
    others = [str(package) for package in family if not _part_of_wpilib(package, wpilib)]
    beside = f"; with {', '.join(others)}" if others else ""
    fine = ok("wpilib", f"{wpilib.version}, and its {len(family) - len(others) - 1} companions fit{beside}")
    yield from problems or [fine]


def _unmet(installed: Installed, family: Sequence[Package], wpilib: Package) -> Iterator[CheckResult]:
    """Yield the unmet requirements, each once."""
    every = [unmet for package in family for unmet in installed.unmet(package)]
    # A package that WPILib needs in another version will be replaced, so its own requirements do not matter.
    odd = {canonicalize_name(unmet.needed.name) for unmet in every if unmet.package.version == wpilib.version}
    by_remedy: dict[str, list[Unmet]] = {}
    for unmet in every:
        if canonicalize_name(unmet.package.name) in odd:
            continue
        # If the version equals WPILib's, the package with the requirement is outdated.
        stays = unmet.there == wpilib.version
        remedy = (
            f"pip install --upgrade {unmet.package.name}"
            if stays
            else f"pip install {quoted_requirement(unmet.needed)}"
        )
        by_remedy.setdefault(remedy, []).append(unmet)
    for remedy, (first, *others) in by_remedy.items():
        also = f"; also needed by {', '.join(str(each.package) for each in others)}" if others else ""
        yield problem("wpilib", f"{first}{also}", remedy)


def _other_seasons(family: Sequence[Package], wpilib: Package) -> Iterator[CheckResult]:
    for package in family:
        if None not in (package.season, wpilib.season) and package.season != wpilib.season:
            yield problem(
                "wpilib",
                f"{package} is for the season {package.season}, {wpilib} for {wpilib.season}",
                f'pip install --upgrade "{package.name}=={_of_season(package, wpilib)}"',
            )


def _of_season(package: Package, wpilib: Package) -> str:
    """Return the version to install, in the package's own numbering."""
    four_digits = len(package.version.partition(".")[0]) == 4
    return f"{wpilib.season if four_digits else str(wpilib.season)[2:]}.*"


def _part_of_wpilib(package: Package, wpilib: Package) -> bool:
    return package.name.startswith("robotpy-native-") or package == wpilib or package.version == wpilib.version


#: Seconds after which imports count as hanging.
TIME_LIMIT = 60.0

# Prints each module before its import: after a crash, the last line has the module that crashed.
_PROGRAM = """
import importlib, sys
sys.path[:] = sys.argv[1].split("\\n")
for name in sys.argv[2:]:
    print("import", name, flush=True)
    try:
        importlib.import_module(name)
    except BaseException as error:
        print("failed", type(error).__name__, " ".join(str(error).split()), flush=True)
"""


def check_imports(installed: Installed, path: list[str] | None = None) -> Iterator[CheckResult]:
    """Check whether each installed library that robots use can be imported.

    :param path: the module search path; default: `sys.path` without the current directory
    """
    of_robots = {package.name for package in installed.of_wpilib()}
    packages = {module: name for module, name in PACKAGES.items() if name in of_robots}
    # The others import it.
    packages = dict(sorted(packages.items(), key=lambda each: each[0] != "wpilib"))
    remaining = list(packages)
    failures = False
    while remaining:
        output, ended = _import(remaining, sys.path if path is None else path)
        reached = remaining[0]
        for line in output.splitlines():
            word, _, rest = line.partition(" ")
            if word == "import" and rest in packages:
                reached = rest
            elif word == "failed":
                failures = True
                yield _failed(packages[reached], reached, rest)
        if ended:
            failures = True
            yield _failed(packages[reached], reached, ended)
        # If a module has ended the process, the modules after it must still be tested.
        remaining = remaining[remaining.index(reached) + 1 :] if ended else []
    if packages and not failures:
        yield ok("imports", f"{', '.join(packages)} can be imported")


def _import(modules: list[str], path: list[str]) -> tuple[str, str]:
    """Return the output of the process, and what ended it early; empty if nothing did."""
    looked_in = [each for each in path if each and Path(each) != Path.cwd()]
    command = [sys.executable, "-c", _PROGRAM, "\n".join(looked_in), *modules]
    try:
        environment = {**os.environ, **WRITES_UTF_8}
        done = subprocess.run(
            command, env=environment, capture_output=True, encoding="utf-8", errors="replace", timeout=TIME_LIMIT
        )
    except subprocess.TimeoutExpired as hanging:
        output = hanging.stdout or b""
        return output.decode("utf-8", "replace") if isinstance(
            output, bytes
        ) else output, f"no end after {TIME_LIMIT:g} s"
    if (crash := crash_of(done.returncode)) is not None:
        return done.stdout, f"crashes Python: {crash}"
    return done.stdout, f"ends Python with {done.returncode}" if done.returncode else ""


def _failed(package: str, module: str, how: str) -> CheckResult:
    remedy = f"pip install --force-reinstall --no-deps {package}"
    if sys.platform == "win32":
        remedy += "; or install Microsoft's Visual C++ Redistributable, which WPILib needs"
    elif "GLIBC" in how:
        remedy = "This system is too old for WPILib: it needs a newer release of your Linux."
    return problem("imports", f"import {module}: {how}", remedy)
