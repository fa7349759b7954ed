"""Where a robot's NetworkTables may be: the addresses that a deploy tries, and this computer, for a simulation."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from ...deploy.discovery import addresses_of, parse_address
from ...deploy.targets import MAX_TEAM, controller_of
from ...deploy.team import find_target
from ...errors import UsageError
from ...project import Project
from ...season import CURRENT
from ...shell import quoted
from ..engine.options import NT4_PORT

#: Where a simulation on this computer serves them.
THIS_COMPUTER = "127.0.0.1"
#: The port that `parse_address` gives to an address without one.
_NO_PORT = 22


@dataclass(frozen=True)
class RobotAddresses:
    """Where to look for a robot.

    :param whose: for people, such as ``team 1234``
    :param servers: hosts and ports; the first that responds is taken
    :param asks_driver_station: whether this computer's Driver Station may know another address
    """

    whose: str
    servers: tuple[tuple[str, int], ...]
    asks_driver_station: bool = False


def addresses_for(given: str | None, project: Project | None) -> RobotAddresses:
    """Return where to look.

    :param given: a team's number, ``HOST`` or ``HOST:PORT``; None: the project's robot, and this computer
    :raises UsageError: when it is none of these
    """
    if given is not None:
        if not re.fullmatch(r"-?[0-9]{1,9}", given.strip()):
            if Path(given).is_file():
                remedy = f"To look at a log: pyfrc view {quoted(given)}"
                raise UsageError(f"--robot {given}: this is a file, not an address", remedy=remedy)
            return _of_host(given)
        if not 1 <= int(given) <= MAX_TEAM:
            raise UsageError(f"--robot {given}: a team's number is from 1 to {MAX_TEAM}")
        return _of_team(int(given))
    try:
        target = None if project is None else find_target(project)
    except UsageError:  # it names no robot
        target = None
    if target is None:
        return RobotAddresses("this computer", ((THIS_COMPUTER, NT4_PORT),))
    found = _of_host(target.robot) if target.robot is not None else _of_team(target.team or 0)
    return RobotAddresses(
        f"{found.whose}, or this computer", (*found.servers, (THIS_COMPUTER, NT4_PORT)), found.asks_driver_station
    )


def _of_team(team: int) -> RobotAddresses:
    hosts = dict.fromkeys(address.host for address, _ in addresses_of(team, controller_of(CURRENT)))
    return RobotAddresses(f"team {team}", tuple((host, NT4_PORT) for host in hosts), asks_driver_station=True)


def _of_host(text: str) -> RobotAddresses:
    try:
        address = parse_address(text)
    except UsageError as error:
        remedy = "Write a team's number or an address, as in: --robot 1234, --robot 10.12.34.2"
        raise UsageError(error.message, where="--robot", remedy=remedy) from None
    port = NT4_PORT if address.port == _NO_PORT else address.port
    return RobotAddresses(address.host if port == NT4_PORT else str(address), ((address.host, port),))
