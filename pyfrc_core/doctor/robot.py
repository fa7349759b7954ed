"""Whether the robot can be reached: asked while everything else is looked at."""

from __future__ import annotations

import threading

from ..deploy.discovery import addresses_of, find_robot, parse_address
from ..deploy.errors import OnTheFieldError, RobotNotFoundError
from ..deploy.team import Target, find_target
from ..errors import PyfrcError, SettingsError, UsageError
from ..project import Project
from .findings import Finding, hint, ok, problem
from .robot_project import problem_of

#: Seconds that the robot gets to answer, when all else has been looked at.
PATIENCE = 3.0

_TOPIC = "robot"

_REMEDY = (
    "Nothing to do while the robot is off. Else: is this computer on its network, or at its USB cable? "
    "pyfrc deploy says what was tried."
)


class RobotSearch:
    """A search for the robot, begun at once; it changes nothing on it, and does not log in.

    :param robot: its address, when the user has named one
    :param team: the team's number, when the user has
    """

    def __init__(self, project: Project | None, robot: str | None = None, team: int | None = None) -> None:
        self._named = robot is not None or team is not None
        self._finding: Finding | None = None
        self._whose = robot or (f"team {team}" if team is not None else "this project")
        self._thread = threading.Thread(target=self._run, args=(project, robot, team), daemon=True)
        self._thread.start()

    def finding(self) -> Finding:
        """What has come of it until now, or comes of it soon."""
        self._thread.join(PATIENCE)
        return self._finding or self._silent()

    def _run(self, project: Project | None, robot: str | None, team: int | None) -> None:
        try:
            self._finding = self._search(project, robot, team)
        except OnTheFieldError:
            self._finding = ok(_TOPIC, "the Driver Station is connected to a competition field: left alone")
        except RobotNotFoundError:
            self._finding = self._silent()
        except (PyfrcError, OSError) as error:
            self._finding = problem_of(_TOPIC, error, "Correct it there.")

    def _search(self, project: Project | None, robot: str | None, team: int | None) -> Finding:
        if project is None and not self._named:
            return hint(_TOPIC, "not looked for: without a project nobody says whose", "pyfrc doctor --team NUMBER")
        try:
            target = Target(team, robot) if project is None else find_target(project, robot=robot, team=team)
        except SettingsError:
            raise
        except UsageError as unknown:
            return hint(_TOPIC, f"not looked for: {unknown.message}", unknown.remedy or "pyfrc doctor --team NUMBER")
        if target.robot is not None:
            self._whose = target.robot
            candidates = [(parse_address(target.robot), target.source)]
        else:
            assert target.team is not None
            self._whose = f"team {target.team}"
            candidates = addresses_of(target.team)
        found = find_robot(candidates, self._whose, take_its_robot=target.robot is None)
        found.connected.close()
        return ok(_TOPIC, f"{self._whose} answers at {found.address} ({found.kind})")

    def _silent(self) -> Finding:
        text = f"{self._whose}: no robot answers"
        return problem(_TOPIC, text, _REMEDY) if self._named else hint(_TOPIC, text, _REMEDY)
