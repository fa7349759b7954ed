"""What an opmode is: from 2027 on, robots publish some, and the driver station chooses one. It imports no WPILib."""

from __future__ import annotations

import re
from typing import Any, NamedTuple, Protocol

#: The robot's modes that have opmodes, by WPILib's numbers for them.
MODES = {1: "autonomous", 2: "teleop", 3: "test"}
#: Finds an opmode's class in the text of a file.
DECORATED = re.compile(r"^\s*@(\w+\.)*(autonomous|teleop|utility)\b", re.MULTILINE)
_WPILIBS_NAMES = {"teleoperated": "teleop", "utility": "test"}


class Opmode(NamedTuple):
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
