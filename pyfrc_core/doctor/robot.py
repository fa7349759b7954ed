"""Checks whether the robot can be reached and is ready for a deploy, in the background."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from contextlib import closing

from ..config.robotpy import load_robot_packages
from ..deploy.agent_client import AgentClient
from ..deploy.connection import Connection, connect
from ..deploy.discovery import RobotNotFoundError, parse_address
from ..deploy.errors import HostKeyError, NoPythonError, OnTheFieldError
from ..deploy.facts import RobotFacts
from ..deploy.robot_checks import RobotWithoutPython, image_it, image_problem, named, obstacles
from ..deploy.robot_packages import unfit_packages
from ..deploy.target_connection import load_robot_keys, search
from ..deploy.targets import ControllerKind, controller_of
from ..deploy.team import find_target
from ..errors import PyfrcError, SettingsError, UsageError
from ..project import Project
from ..season import CURRENT, installed_wpilib
from .check_result import CheckResult, hint, ok, problem
from .robot_project import problem_from_error
from .steps import Step

#: Seconds to wait for a robot after all other checks.
SEARCH_SECONDS = 3.0
#: Additional seconds to check a robot that was found: connecting and starting its Python takes a robot some time.
CHECK_SECONDS = 20.0

_TOPIC = "robot"

_REMEDY = (
    "If the robot is off, there is nothing to do. Otherwise, check the network or the USB cable; pyfrc deploy lists "
    "the addresses that were tried."
)


class RobotSearch:
    """Searches for the robot and checks it, in the background. Nothing is changed, and no key is pinned.

    :param robot: the robot's address, if the user specifies it
    :param team: the team number, if the user specifies it
    """

    def __init__(self, project: Project | None, robot: str | None = None, team: int | None = None) -> None:
        self._named = robot is not None or team is not None
        self._findings: list[CheckResult] = []
        self._next: tuple[Step, str] | None = None
        self._found = False
        self._whose = "the robot"
        self._thread = threading.Thread(target=self._run, args=(project, robot, team), daemon=True)
        self._thread.start()

    def findings(self) -> list[CheckResult]:
        """Wait for the results, within the time limits, and return them."""
        self._thread.join(SEARCH_SECONDS)
        if self._found:
            self._thread.join(CHECK_SECONDS)
        findings = list(self._findings)
        if not findings:
            return [self._not_found()]
        if self._thread.is_alive():
            findings.append(
                hint(_TOPIC, "the check is not finished yet", "To see the robot's state: pyfrc deploy-info")
            )
        return findings

    def missing_step(self) -> tuple[Step, str] | None:
        """Return the first step to a driving robot that is missing, and how to do it; None if that is unknown.

        `findings` has been called before.
        """
        return self._next

    def _run(self, project: Project | None, robot: str | None, team: int | None) -> None:
        try:
            for finding in self._search(project, robot, team):
                self._findings.append(finding)
        except OnTheFieldError:
            self._findings.append(ok(_TOPIC, "not checked: the Driver Station is connected to a competition field"))
        except RobotNotFoundError:
            self._findings.append(self._not_found())
            controller = controller_of(CURRENT)
            remedy = " ".join(filter(None, (_REMEDY, controller.radio, f"For a new one: {image_it(controller)}")))
            self._next = Step.CONTROLLER, remedy
        except HostKeyError as error:
            remedy = "If this is your robot, pyfrc deploy-info shows how to accept its key."
            self._next = Step.CONTROLLER, remedy
            self._findings.append(problem(_TOPIC, error.message, remedy))
        except (PyfrcError, OSError) as error:
            self._findings.append(problem_from_error(_TOPIC, error, "Correct it there."))
        except ImportError as error:  # another check reports the missing package
            remedy = "Solve the problems with pyfrc first."
            self._findings.append(hint(_TOPIC, f"cannot be checked: {error}", remedy))

    def _search(self, project: Project | None, robot: str | None, team: int | None) -> Iterator[CheckResult]:
        if project is None and not self._named:
            yield hint(_TOPIC, "not searched: no team is known outside of a project", "pyfrc doctor --team NUMBER")
            return
        try:
            target = find_target(project, robot=robot, team=team)
        except SettingsError:
            raise
        except UsageError as unknown:
            yield hint(_TOPIC, f"not searched: {unknown.message}", unknown.remedy or "pyfrc doctor --team NUMBER")
            self._next = Step.TEAM, "pyfrc deploy asks for it, and keeps it in .wpilib/wpilib_preferences.json"
            return
        self._whose = f"team {target.team}" if target.robot is None else str(parse_address(target.robot))
        found = search(target)
        with found.connected:
            self._found = True
            yield ok(_TOPIC, f"{self._whose} found at {found.address} ({found.kind})")
            keys = load_robot_keys(target, found.address)
            with connect(found.address, target.controller, keys, connected=found.connected, pin=False) as connection:
                yield from self._examine(project, connection)

    def _examine(self, project: Project | None, connection: Connection) -> Iterator[CheckResult]:
        try:
            robot = AgentClient.start(connection, python=connection.python())
        except NoPythonError:
            without_python = list(RobotWithoutPython(connection).obstacles())
            self._next = (Step.PACKAGES if len(without_python) == 1 else Step.CONTROLLER), without_python[0].remedy
            yield from (problem(_TOPIC, each.text, each.remedy) for each in without_python)
        else:
            with closing(robot):
                found = list(check_robot_facts(robot.facts, connection.controller, project))
                self._next = missing_on_robot(robot.facts, connection.controller, found)
                yield from found
                if robot.facts.not_controller is None and (different := robot.check()):
                    text = f"damaged on its disk, or changed there: {named(different)}"
                    yield problem(_TOPIC, text, "To send it again: pyfrc deploy --reinstall")

    def _not_found(self) -> CheckResult:
        text = f"{self._whose}: no robot found"
        return problem(_TOPIC, text, _REMEDY) if self._named else hint(_TOPIC, text, _REMEDY)


def check_robot_facts(facts: RobotFacts, controller: ControllerKind, project: Project | None) -> Iterator[CheckResult]:
    """Check whether a robot is ready for this project, as a deploy does."""
    problems = [problem(_TOPIC, each.text, each.remedy) for each in obstacles(facts, controller)]
    if project is not None and facts.not_controller is None and facts.wpilib is not None:
        packages = load_robot_packages(project.pyproject)
        problems += [problem(_TOPIC, str(each), each.remedy) for each in unfit_packages(packages, facts)]
    ready = f"Python {facts.python}, wpilib {facts.wpilib}, image {facts.image}"
    yield from problems or [ok(_TOPIC, ready)]


def missing_on_robot(facts: RobotFacts, controller: ControllerKind, found: Sequence[CheckResult]) -> tuple[Step, str]:
    """Return the first step that is missing on a robot.

    :param found: the results about it
    """
    if facts.not_controller is not None or image_problem(facts.image, installed_wpilib() or "", controller):
        return Step.CONTROLLER, image_it(controller)
    wrong = next((each for each in found if each.status == "problem"), None)
    if wrong is not None:
        return Step.PACKAGES, wrong.remedy or ""
    if facts.current is None and not facts.other_code:
        return Step.PROGRAM, "pyfrc deploy"
    if not facts.running:
        return (
            Step.PROGRAM,
            "It is there, but does not run. To see why: pyfrc deploy-info. After a correction: pyfrc deploy",
        )
    return Step.DRIVE, ""
