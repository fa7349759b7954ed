"""Whether the robot can be reached, and is ready for a deploy: found out while everything else is looked at."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence

from ..config.robotpy import load_robot_packages
from ..deploy.connection import Connection, connect
from ..deploy.discovery import RobotNotFoundError, addresses_of, find_robot, parse_address
from ..deploy.errors import HostKeyError, NoPythonError, OnTheFieldError
from ..deploy.facts import RobotFacts
from ..deploy.preparing import other_languages_notice
from ..deploy.reach import keys_of_robot
from ..deploy.robot import Robot
from ..deploy.robot_checks import obstacles
from ..deploy.robot_packages import unfit_packages
from ..deploy.team import Target, find_target
from ..deploy.without_python import RobotWithoutPython
from ..errors import PyfrcError, SettingsError, UsageError
from ..project import Project
from .findings import Finding, hint, ok, problem
from .robot_project import problem_of

#: Seconds until a robot has to be found, when all else has been looked at.
PATIENCE = 3.0
#: Seconds more to look at one that was found: a roboRIO takes some for the connection and the start of its Python.
PATIENCE_WITH_FOUND = 20.0

_TOPIC = "robot"

_REMEDY = (
    "Nothing to do while the robot is off. Else: is this computer on its network, or at its USB cable? "
    "pyfrc deploy says what was tried."
)


class RobotSearch:
    """A search for the robot, begun at once; it changes nothing on it or here, and pins no key.

    :param robot: its address, when the user has named one
    :param team: the team's number, when the user has
    """

    def __init__(self, project: Project | None, robot: str | None = None, team: int | None = None) -> None:
        self._named = robot is not None or team is not None
        self._findings: list[Finding] = []
        self._found = False
        self._whose = robot or (f"team {team}" if team is not None else "this project")
        self._thread = threading.Thread(target=self._run, args=(project, robot, team), daemon=True)
        self._thread.start()

    def findings(self) -> list[Finding]:
        """What has come of it until now, or comes of it soon."""
        self._thread.join(PATIENCE)
        if self._found:
            self._thread.join(PATIENCE_WITH_FOUND)
        findings = list(self._findings)
        if not findings:
            return [self._silent()]
        if self._thread.is_alive():
            findings.append(hint(_TOPIC, "looking at it takes long", "See what is on it with: pyfrc deploy-info"))
        return findings

    def _run(self, project: Project | None, robot: str | None, team: int | None) -> None:
        try:
            for finding in self._search(project, robot, team):
                self._findings.append(finding)
        except OnTheFieldError:
            self._findings.append(ok(_TOPIC, "the Driver Station is connected to a competition field: left alone"))
        except RobotNotFoundError:
            self._findings.append(self._silent())
        except HostKeyError as error:
            remedy = "pyfrc deploy-info shows how to accept its key, if it is your robot."
            self._findings.append(problem(_TOPIC, error.message, remedy))
        except (PyfrcError, OSError) as error:
            self._findings.append(problem_of(_TOPIC, error, "Correct it there."))
        except ImportError as error:  # what is missing for that is a finding of its own
            remedy = "Correct what is said about pyfrc first."
            self._findings.append(hint(_TOPIC, f"could not be looked at: {error}", remedy))

    def _search(self, project: Project | None, robot: str | None, team: int | None) -> Iterator[Finding]:
        if project is None and not self._named:
            yield hint(_TOPIC, "not looked for: outside of a project, no team is known", "pyfrc doctor --team NUMBER")
            return
        try:
            target = Target(team, robot) if project is None else find_target(project, robot=robot, team=team)
        except SettingsError:
            raise
        except UsageError as unknown:
            yield hint(_TOPIC, f"not looked for: {unknown.message}", unknown.remedy or "pyfrc doctor --team NUMBER")
            return
        if target.robot is not None:
            address = parse_address(target.robot)
            self._whose = str(address)
            candidates = [(address, target.source)]
        else:
            assert target.team is not None
            self._whose = f"team {target.team}"
            candidates = addresses_of(target.team)
        found = find_robot(candidates, self._whose, take_its_robot=target.robot is None)
        with found.connected:
            self._found = True
            yield ok(_TOPIC, f"{self._whose} answers at {found.address} ({found.kind})")
            keys = keys_of_robot(project, target, found)
            with connect(found.address, keys, connected=found.connected, pin=False) as connection:
                yield from _examine(project, connection)

    def _silent(self) -> Finding:
        text = f"{self._whose}: no robot answers"
        return problem(_TOPIC, text, _REMEDY) if self._named else hint(_TOPIC, text, _REMEDY)


def _examine(project: Project | None, connection: Connection) -> Iterator[Finding]:
    try:
        robot = Robot.start(connection)
    except NoPythonError:
        there = RobotWithoutPython(connection)
        yield from (problem(_TOPIC, each.text, each.remedy) for each in there.obstacles())
        yield from _examine_other_languages(there.other_languages)
    else:
        robot.close()
        yield from examine_facts(robot.facts, project)


def examine_facts(facts: RobotFacts, project: Project | None) -> Iterator[Finding]:
    """Whether a robot is ready for programs in Python, and for this project's: what a deploy would refuse."""
    problems = [problem(_TOPIC, each.text, each.remedy) for each in obstacles(facts)]
    if project is not None and facts.not_roborio is None and facts.wpilib is not None:
        packages = load_robot_packages(project.pyproject)
        problems += [problem(_TOPIC, str(each), each.remedy) for each in unfit_packages(packages, facts)]
    ready = f"Python {facts.python}, wpilib {facts.wpilib}, image {facts.image}"
    yield from problems or [ok(_TOPIC, ready)]
    yield from _examine_other_languages(facts.other_languages)


def _examine_other_languages(found: Sequence[str]) -> Iterator[Finding]:
    if found:
        text, remedy = other_languages_notice(found)
        yield hint(_TOPIC, text, remedy)
