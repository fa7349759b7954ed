"""What an opmode is: from 2027 on, robots publish some, and the driver station chooses one. It imports no WPILib."""

from __future__ import annotations

from typing import NamedTuple


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
