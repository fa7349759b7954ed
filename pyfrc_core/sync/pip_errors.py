"""Why pip found no packages for the robot: its output as one error, with what to do."""

from __future__ import annotations

import os
import re

from ..errors import PyfrcError
from ..season import Season
from .addresses import INDEX_VARIABLE


class NothingFitsError(PyfrcError):
    """There are no wheels that meet the requirements."""


#: Lines of pip's explanation of a conflict.
_MOST_REASONS = 6

_MISSING = re.compile(
    r"Could not find a version that satisfies the requirement (?P<needed>.+?)"
    r"(?: \(from (?!versions:)(?P<by>[^)]+)\))? \(from versions: (?P<there>[^)]*)\)"
)
_WPILIB = re.compile(r"(robotpy|wpilib|pyntcore)(?![a-z])")
_CONFLICT = re.compile(r"The conflict is caused by:\s*\n(?P<reasons>(?:[ \t]+\S.*\n)+)")
_UNREACHABLE = re.compile(r"Retrying \(Retry\(|Could not fetch URL|Connection to \S+ timed out|ConnectTimeoutError")
_REASON = re.compile(r"\[Errno -?\d+\] ([^'\")\n]+)|(certificate.verify.failed)|(timed out)", re.IGNORECASE)
_INDEXES = re.compile(r"^Looking in indexes: (.+)$", re.MULTILINE)
_WRONG_HASH = re.compile(r"DO NOT MATCH THE HASHES[^\n]*\n\s+(\S.*?) from ([^\s#]+)")
_FULL = "No space left on device"
_ERROR = re.compile(r"^ERROR: (?!Ignored the following|pip's dependency resolver)(.+)$", re.MULTILINE)


def explain(printed: str, season: Season) -> PyfrcError:
    """Return the error that pip's output is about."""
    if _FULL in printed:
        return PyfrcError("the disk is full", remedy="Free some space, and run pyfrc sync again.")
    if (wrong := _WRONG_HASH.search(printed)) is not None:
        return PyfrcError(
            f"{wrong[1]}: {wrong[2].rstrip(':')} has another content than its index says (its SHA-256 differs)",
            remedy="Run pyfrc sync again, or in another network. If it stays so, the index is wrong, or the file is.",
        )
    if (missing := _MISSING.search(printed)) is not None:
        unreachable = _UNREACHABLE.search(printed) is not None
        return unreachable_index(printed) if unreachable else _no_wheel(missing, season)
    if (conflict := _CONFLICT.search(printed)) is not None:
        return _conflicting(conflict["reasons"])
    if _UNREACHABLE.search(printed):
        return unreachable_index(printed)
    errors = _ERROR.findall(printed) or [line for line in printed.splitlines() if line.strip()][-1:]
    said = errors[0].strip() if errors else "it printed nothing"
    return PyfrcError(f"pip could not find the packages: {said}", remedy="pyfrc -v sync prints more.")


def unreachable_index(printed: str) -> PyfrcError:
    """Return the error for an index that pip cannot reach."""
    if (found := _REASON.search(printed)) is None:
        why = "no connection"
    elif found[2]:
        why = "its certificate could not be verified"
    else:
        why = found[1] or found[3]
    remedy = "Connect this computer to the internet, or copy the cache and the lock from one that has run pyfrc sync."
    if found is not None and found[2]:
        remedy = "A network that inspects connections needs its certificate in pip's settings: docs/reference/sync.md."
    listed = ", ".join(indexes_in(printed))
    looked_in = f"; pip has looked in {listed}" if listed else ""
    return PyfrcError(f"a package index cannot be reached: {why.strip()}{looked_in}", remedy=remedy)


def indexes_in(printed: str) -> list[str]:
    """Return the addresses of the indexes in which pip has looked, as far as it prints them."""
    listed = _INDEXES.search(printed)
    return listed[1].split(", ") if listed else []


def _no_wheel(missing: re.Match[str], season: Season) -> PyfrcError:
    robot = f"the {season.controller.name} (Python {'.'.join(map(str, season.controller.python))})"
    text = f"there is no wheel of {missing['needed']} for {robot}"
    if missing["by"]:
        text = f"{text}; {missing['by']} needs it"
    there = [each.strip() for each in missing["there"].split(",") if each.strip() not in ("", "none")]
    if _WPILIB.match(missing["needed"]) and not any(each.startswith(f"{season.year}.") for each in there):
        # Other indexes have placeholders of old years under these names.
        index = os.environ.get(INDEX_VARIABLE)
        where = f"{INDEX_VARIABLE} is {index or 'empty'}, so that these wheels were not looked for there"
        return NothingFitsError(
            f"{text}; WPILib's wheels of {season.year} are on {season.downloads.index}",
            remedy=f"{where}. Unset it, or name a mirror of that index." if index is not None else "Look there for it.",
        )
    if there:
        shown = ", ".join(there[-5:])
        text = f"{text}; there are wheels of {'... ' if there[5:] else ''}{shown}"
        return NothingFitsError(text, remedy="Ask for one of these versions under [tool.robotpy] in pyproject.toml.")
    return NothingFitsError(
        text,
        remedy="Check the name and the version under [tool.robotpy] in pyproject.toml. A package with C code needs a "
        "wheel for the robot from its authors. One in Python alone: python -m pip wheel --no-deps --wheel-dir "
        "wheels PACKAGE, and: pyfrc sync --find-links wheels",
    )


def _conflicting(reasons: str) -> PyfrcError:
    lines = [line.strip() for line in reasons.splitlines()]
    shown = "; ".join(line.replace("The user requested", "[tool.robotpy] has") for line in lines[:_MOST_REASONS])
    more = f"; and {len(lines) - _MOST_REASONS} more" if len(lines) > _MOST_REASONS else ""
    return NothingFitsError(
        f"the requirements contradict each other: {shown}{more}",
        remedy="Change the versions under [tool.robotpy] in pyproject.toml.",
    )
