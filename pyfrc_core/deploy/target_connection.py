"""Choosing the robot, finding it, connecting to it, and starting the agent on it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..project import Project
from .connection import Connection, connect, load_in_background
from .credentials import NONE_OFFERED, Credentials
from .discovery import Address, FoundRobot, addresses_of, find_robot, parse_address
from .early_connection import EarlyConnection
from .errors import NoPythonError
from .host_keys import HostKeys, RobotKeys
from .progress import DeployProgress, Questions
from .recovery_hints import explain_interruption
from .team import RobotTarget, find_target, team_of_project

if TYPE_CHECKING:
    from .agent_client import AgentClient
    from .manifest import Manifest


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


def locate(target: RobotTarget, choice: RobotChoice) -> FoundRobot:
    """Find the robot, and return it with an open socket.

    :raises RobotNotFoundError: with all failed attempts
    :raises OnTheFieldError: if the Driver Station is connected to a competition field
    """
    load_in_background()
    if target.robot is not None:
        address = parse_address(target.robot)
        return find_robot([(address, f"by {target.source}")], str(address), take_its_robot=False)
    assert target.team is not None
    whose = f"team {target.team} (by {target.source})"
    return find_robot(addresses_of(target.team, choice.resolve), whose)


def find(target: RobotTarget, choice: RobotChoice, progress: DeployProgress) -> FoundRobot:
    """Do the same as `locate`, as a phase of the command."""
    return _show_found(lambda: locate(target, choice), progress)


def _show_found(find: Callable[[], FoundRobot], progress: DeployProgress) -> FoundRobot:
    with progress.phase("find") as phase:
        found = find()
        phase.detail = f"{found.address} ({found.kind})"
    return found


def load_robot_keys(project: Project | None, target: RobotTarget, found: FoundRobot) -> RobotKeys:
    """Return the known host keys of the robot: of the project, or of this user outside of a project."""
    if project is None:
        return HostKeys.of_this_user().of_robot(found.address, target.team)
    keys = HostKeys(project.pyproject.parent)
    return keys.of_robot(found.address, target.team, team_of_project(project) if target.team is None else None)


def log_in(project: Project | None, target: RobotTarget, choice: RobotChoice, found: FoundRobot) -> Connection:
    """Log in to the robot that was found.

    Its host key is compared with the project's known keys or, outside of a project, with this user's.

    :raises HostKeyError: if the key is not known
    :raises ConnectionFailedError: if the login fails
    """
    return connect(
        found.address,
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
    with _show_connected(lambda: log_in(project, target, choice, found), progress) as connection:
        yield connection


def _show_connected(connect: Callable[[], Connection], progress: DeployProgress) -> Connection:
    with progress.phase("connect") as phase:
        connection = connect()
        recognized = connection.recognized
        phase.detail = "its key is known"
        if recognized.new_for is not None:
            phase.detail = f"a new key, now pinned for {recognized.new_for}"
        if recognized.name:
            phase.detail += f" ({recognized.name})"
    if recognized.new_for is not None:
        progress.note(f"  its key: {connection.key.fingerprint} ({connection.key.kind})")
    return connection


def connect_early(project: Project | None, target: RobotTarget, choice: RobotChoice) -> EarlyConnection:
    """Begin to connect to the robot in the background. `connected_early` must follow."""
    return EarlyConnection(partial(locate, target, choice), partial(log_in, project, target, choice))


def connected_early(early: EarlyConnection, progress: DeployProgress) -> Connection:
    """Wait for the login that was begun in the background."""
    _show_found(early.found, progress)
    return _show_connected(early.connection, progress)


@contextmanager
def running_agent(
    connection: Connection,
    progress: DeployProgress,
    modules: Sequence[str] = (),
    start: Callable[[], AgentClient] | None = None,
    manifest: Manifest | None = None,
) -> Iterator[AgentClient]:
    """Start the agent on the robot, and end it after the ``with`` block.

    :param modules: modules to look for in the robot's Python
    :param start: returns an agent that was started before
    :param manifest: the files of the deploy that follows, if it is known
    :raises RefusedError: if there is no Python on the robot
    """
    from .agent_client import AgentClient

    with progress.phase("look") as phase:
        try:
            robot = AgentClient.open(connection) if start is None else start()
            robot.begin({"modules": modules} if modules else None, manifest)
        except NoPythonError as error:
            from .without_python import RobotWithoutPython  # not before, since it is rare

            raise RobotWithoutPython(connection).refusal(error) from error
        facts = robot.facts
        phase.detail = f"wpilib {facts.wpilib or 'missing'}, image {facts.image or 'unknown'}"
    try:
        with explain_interruption(robot):
            yield robot
    finally:
        robot.close()


@contextmanager
def connected_agent(
    project: Project | None, target: RobotTarget, choice: RobotChoice, progress: DeployProgress
) -> Iterator[tuple[Connection, AgentClient]]:
    """Find the robot, connect to it and start the agent."""
    found = find(target, choice, progress)
    with (
        connected(project, target, found, choice, progress) as connection,
        running_agent(connection, progress) as robot,
    ):
        yield connection, robot


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
