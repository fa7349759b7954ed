"""What an opmode is: from 2027 on, robots publish some, and the driver station chooses one. It imports no WPILib."""

from __future__ import annotations

import re
from collections.abc import Collection
from difflib import get_close_matches
from typing import Any, NamedTuple, Protocol

from ..errors import UsageError

#: The robot's modes that have opmodes, by WPILib's numbers for them.
MODES = {1: "autonomous", 2: "teleop", 3: "test"}
#: The decorators of opmodes' classes: each is called like its mode.
DECORATORS = ("autonomous", "teleop", "utility")
#: Finds an opmode's class in the text of a file.
DECORATED = re.compile(rf"^\s*@(\w+\.)*({'|'.join(DECORATORS)})\b", re.MULTILINE)
_WPILIBS_NAMES = {"teleoperated": "teleop", "utility": "test"}
#: What users call a mode, where that is another word.
_WORDS = {"test": "utility"}


class PublishedOpmode(NamedTuple):
    """An opmode that the robot has published.

    :param mode: the robot's mode that it is for: ``autonomous``, ``teleop`` or ``test``
    :param id: WPILib's number for it, which follows from mode and name
    """

    name: str
    mode: str
    id: int
    group: str = ""
    description: str = ""


class OpmodeOfTests(Protocol):
    """What the fixture `opmode` gives: that of WPILib's own tests, with WPILib's enumeration of modes."""

    @property
    def name(self) -> str: ...

    @property
    def mode(self) -> Any: ...


def mode_name(mode: Any) -> str:
    """Return the name of a mode, from that or WPILib's name for it, or a member of WPILib's enumeration."""
    if isinstance(mode, str):
        return _WPILIBS_NAMES.get(mode.lower(), mode.lower())
    return MODES.get(int(mode), "")


def find_opmode(published: Collection[PublishedOpmode], opmode: str | OpmodeOfTests, mode: str = "") -> PublishedOpmode:
    """Return the opmode of a name, from those that the robot has published.

    :param opmode: its name, or what the fixture `opmode` gives
    :param mode: the mode that it is for, if it is a name
    :raises UsageError: when there is no such opmode, or several
    """
    if not isinstance(opmode, str) and (isinstance(opmode, type) or not hasattr(opmode, "mode")):
        what = f"the class {opmode.__name__}" if isinstance(opmode, type) else type(opmode).__name__
        raise UsageError(f"an opmode is chosen by its name, not by {what}", remedy=f"{_there(published)}.")
    name, mode = (opmode, mode) if isinstance(opmode, str) else (opmode.name, opmode.mode)
    mode = mode_name(mode)
    named = [each for each in published if each.name == name]
    found = [each for each in named if mode in ("", each.mode)]
    if len(found) == 1:
        return found[0]
    modes = [_WORDS.get(each.mode, each.mode) for each in named]
    if found:
        raise UsageError(
            f"there are opmodes {name!r} for {' and '.join(modes)}",
            remedy=f"Choose one: {' or '.join(f'mode={each!r}' for each in modes)}.",
        )
    if named:
        raise UsageError(f"the opmode {name!r} is for {' and '.join(modes)}, not for {_WORDS.get(mode, mode)}")
    raise no_opmode(name, published)


def no_opmode(name: str, published: Collection[PublishedOpmode]) -> UsageError:
    """Return the error that the robot has published no opmode of this name."""
    by_lower_case = {each.name.lower(): each.name for each in published}
    close = get_close_matches(name.lower(), by_lower_case, n=1)
    remedy = f"Did you mean {by_lower_case[close[0]]!r}?" if close else None
    there = _there(published)
    return UsageError(f"there is no opmode {name!r}: {there[0].lower()}{there[1:]}", remedy=remedy)


def _there(published: Collection[PublishedOpmode]) -> str:
    there = ", ".join(f"{each.name!r} ({_WORDS.get(each.mode, each.mode)})" for each in published)
    return f"The robot has published {there or 'none'}"
