"""What a deploy does differently on each controller: one module with one `ControllerKind` for each.

No other part of a deploy names a controller. To add one, write a module such as `roborio`, and add its record to
`CONTROLLERS`. The agent on the robot gets the record's `layout` in the first message.
"""

from __future__ import annotations

from ...season import Season
from .controller import AdministratorTask, ControllerKind, DriverStation, PythonInstaller
from .roborio import ROBORIO
from .systemcore import SYSTEMCORE

__all__ = [
    "CONTROLLERS",
    "MAX_TEAM",
    "AdministratorTask",
    "ControllerKind",
    "DriverStation",
    "PythonInstaller",
    "controller_named",
    "controller_of",
    "is_shared_host",
    "team_of_host",
]

CONTROLLERS = (ROBORIO, SYSTEMCORE)
#: The highest team number that an address 10.TE.AM.2 can contain.
MAX_TEAM = 25_599


def controller_of(season: Season) -> ControllerKind:
    """Return the controller of a season's robots."""
    return controller_named(season.controller.name)


def controller_named(name: str) -> ControllerKind:
    """Return the controller with this name."""
    return next(each for each in CONTROLLERS if each.name == name)


def team_of_host(host: str) -> int | None:
    """Return the team to which a host name or an address belongs; None: to no team, or to all."""
    teams = (each.team_of_host(host) for each in CONTROLLERS)
    return next((team for team in teams if team is not None and 1 <= team <= MAX_TEAM), None)


def is_shared_host(host: str) -> bool:
    """Return whether any team's robot may have this host, as at this computer's USB cable."""
    return any(host in each.shared_hosts for each in CONTROLLERS)
