"""Choosing the robot, finding it, connecting to it, and starting the agent on it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..project import Project
from .connection import Connection, connect, load_in_background
from .credentials import NONE_OFFERED, Credentials
from .discovery import Address, FoundRobot, addresses_of, find_robot, parse_address
from .errors import NoPythonError
from .host_keys import HostKeys, RobotKeys
from .progress import DeployProgress, Questions
from .recovery_hints import explain_interruption
from .team import RobotTarget, find_target, team_of_project

if TYPE_CHECKING:
    from .agent_client import AgentClient


@dataclass(frozen=True)
class RobotChoice:
    """The robot options of a command.

    :param robot: the robot's address, as ``HOST`` or ``HOST:PORT``
    :param team: a team number
    :param resolve: whether host names may be resolved
    :param accepted_key: the fingerprint of a changed host key that the user accepts
    :param robot_name: a name to store with the robot's key
    :param credentials: the user's own keys, for a robot that requires one
    """

    robot: str | None = None
    team: int | None = None
    resolve: bool = True
    accepted_key: str | None = None
    robot_name: str | None = None
    credentials: Credentials = NONE_OFFERED

    @property
    def names_robot(self) -> bool:
        """Return whether the options select a robot without a project."""
        return self.robot is not None or self.team is not None


def choose_target(project: Project | None, choice: RobotChoice, ask: Questions | None) -> RobotTarget:
    """Return the robot to connect to. Ask the user if neither the options nor the project name one.

    :param project: None outside of a project, if the options name a robot
    :param ask: None if the user cannot be asked
    :raises UsageError: if no robot is named and the user cannot be asked, or a team number is invalid
    """
    target = find_target(project, robot=choice.robot, team=choice.team, ask=ask.text if ask else None)
    if target.robot is not None and parse_address(target.robot).is_name and not choice.resolve:
        raise UsageError(
            f"{target.robot} is a host name, which --no-resolve does not resolve",
            remedy="Leave out --no-resolve, or give the robot's address with --robot, as in 10.12.34.2",
        )
    return target


def find(target: RobotTarget, choice: RobotChoice, progress: DeployProgress) -> FoundRobot:
    """Do the same as `locate`, as a phase of the command."""
    with progress.phase("find") as phase:
        found = locate(target, choice)
        phase.detail = f"{found.address} ({found.kind})"
    return found


def locate(target: RobotTarget, choice: RobotChoice) -> FoundRobot:
    """Find the robot, and return it with an open socket.

    :raises RobotNotFoundError: with all failed attempts
    :raises OnTheFieldError: if the Driver Station is connected to a competition field
    """
    load_in_background()
    if target.robot is not None:
        address = parse_address(target.robot)
        return find_robot([(address, f"by {target.source}")], str(address), target.controller, take_its_robot=False)
    assert target.team is not None
    whose = f"team {target.team} (by {target.source})"
    return find_robot(addresses_of(target.team, target.controller, choice.resolve), whose, target.controller)


def load_robot_keys(project: Project | None, target: RobotTarget, found: FoundRobot) -> RobotKeys:
    """Return the known host keys of the robot: of the project, or of this user outside of a project."""
    if project is None:
        return HostKeys.of_this_user().of_robot(found.address, target.controller, target.team)
    keys = HostKeys(project.pyproject.parent)
    project_team = team_of_project(project) if target.team is None else None
    return keys.of_robot(found.address, target.controller, target.team, project_team)


def log_in(project: Project | None, target: RobotTarget, choice: RobotChoice, found: FoundRobot) -> Connection:
    """Log in to the robot that was found.

    Its host key is compared with the project's known keys or, outside of a project, with this user's.

    :raises HostKeyError: if the key is not known
    :raises ConnectionFailedError: if the login fails
    """
    return connect(
        found.address,
        target.controller,
        load_robot_keys(project, target, found),
        connected=found.connected,
        accepted_key=choice.accepted_key,
        robot_name=choice.robot_name,
        credentials=choice.credentials,
    )


@contextmanager
def connected(
    project: Project | None, target: RobotTarget, found: FoundRobot, choice: RobotChoice, progress: DeployProgress
) -> Iterator[Connection]:
    """Log in to the robot that was found, and disconnect after the ``with`` block; see `log_in`."""
    with progress.phase("connect") as phase:
        connection = log_in(project, target, choice, found)
        recognized = connection.recognized
        phase.detail = "its key is known"
        if recognized.new_for is not None:
            phase.detail = f"a new key, now pinned for {recognized.new_for}"
        if recognized.name:
            phase.detail += f" ({recognized.name})"
    with connection:
        if recognized.new_for is not None:
            progress.note(f"  its key: {connection.key.fingerprint} ({connection.key.kind})")
        yield connection


@contextmanager
def connected_agent(
    project: Project | None,
    target: RobotTarget,
    choice: RobotChoice,
    progress: DeployProgress,
    modules: Callable[[], Sequence[str]] = tuple,
) -> Iterator[tuple[Connection, AgentClient]]:
    """Find the robot, connect to it and start the agent. The agent ends after the ``with`` block.

    :param modules: returns the modules to look for in the robot's Python
    :raises RefusedError: if there is no Python on the robot
    """
    found = find(target, choice, progress)
    with connected(project, target, found, choice, progress) as connection:
        robot = _start_agent(connection, progress, modules())
        try:
            with explain_interruption(robot):
                yield connection, robot
        finally:
            robot.close()


def _start_agent(connection: Connection, progress: DeployProgress, modules: Sequence[str]) -> AgentClient:
    from .agent_client import AgentClient

    with progress.phase("look") as phase:
        try:
            robot = AgentClient.start(connection, hello={"modules": modules} if modules else None)
        except NoPythonError as error:
            from .without_python import RobotWithoutPython  # not before, since it is rare

            raise RobotWithoutPython(connection).refusal(error) from error
        facts = robot.facts
        phase.detail = f"wpilib {facts.wpilib or 'missing'}, image {facts.image or 'unknown'}"
    return robot


def console_address(target: RobotTarget, choice: RobotChoice, progress: DeployProgress) -> Address:
    """Return the address of a robot's console.

    An address from the command line is not checked, since the robot may be booting.
    """
    if target.robot is not None:
        return parse_address(target.robot)
    found = find(target, choice, progress)
    host = str(found.connected.getpeername()[0])
    found.connected.close()
    return Address(host)
