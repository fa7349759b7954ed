"""The way to a robot: whose it is, where it answers, the connection, and the agent on it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from ..errors import UsageError
from ..project import Project
from .connection import Connection, connect, load_in_background
from .credentials import NONE_OFFERED, Credentials
from .discovery import Address, Found, addresses_of, find_robot, parse_address
from .errors import NoPythonError
from .host_keys import HostKeys, RobotKeys
from .progress import Progress, Questions
from .robot import Robot
from .standing import told_what_is_so
from .team import Target, find_target, team_of_project
from .without_python import RobotWithoutPython


@dataclass(frozen=True)
class RobotChoice:
    """Which robot the command names, if it does.

    :param robot: its address, as ``HOST`` or ``HOST:PORT``
    :param resolve: whether names may be looked up
    :param accepted_key: the fingerprint of a changed host key that the user accepts
    :param robot_name: a name to be kept with the robot's key
    :param credentials: the user's own keys, offered to a robot that wants one
    """

    robot: str | None = None
    team: int | None = None
    resolve: bool = True
    accepted_key: str | None = None
    robot_name: str | None = None
    credentials: Credentials = NONE_OFFERED

    @property
    def names_robot(self) -> bool:
        """Whether it says by itself which robot is meant, so that no project has to."""
        return self.robot is not None or self.team is not None


def chosen_target(project: Project | None, choice: RobotChoice, ask: Questions | None) -> Target:
    """Whose robot is meant; asked for, where nobody has said it yet.

    :param project: none where the user is not in one, for a choice that names a robot
    :raises UsageError: when there is nobody to ask, or what is said somewhere cannot be
    """
    target = find_target(project, robot=choice.robot, team=choice.team, ask=ask.text if ask else None)
    if target.robot is not None and parse_address(target.robot).is_name and not choice.resolve:
        raise UsageError(
            f"{target.robot} is a name, and with --no-resolve none is looked up",
            remedy="Leave --no-resolve out, or name the robot's address with --robot, as in 10.12.34.2",
        )
    return target


def find(target: Target, choice: RobotChoice, progress: Progress) -> Found:
    """The robot, connected to.

    :raises RobotNotFoundError: with what was tried
    :raises OnTheFieldError: when the Driver Station is connected to a competition field
    """
    load_in_background()
    with progress.phase("find") as phase:
        if target.robot is not None:
            address = parse_address(target.robot)
            found = find_robot([(address, f"by {target.source}")], str(address), take_its_robot=False)
        else:
            assert target.team is not None
            whose = f"team {target.team} (by {target.source})"
            found = find_robot(addresses_of(target.team, choice.resolve), whose)
        phase.detail = f"{found.address} ({found.kind})"
    return found


def keys_of_robot(project: Project | None, target: Target, found: Found) -> RobotKeys:
    """The keys that the robot may have: of the project, or of this user where there is no project."""
    if project is None:
        return HostKeys.of_this_user().of_robot(found.address, target.team)
    keys = HostKeys(project.pyproject.parent)
    return keys.of_robot(found.address, target.team, team_of_project(project) if target.team is None else None)


@contextmanager
def connected(
    project: Project | None, target: Target, found: Found, choice: RobotChoice, progress: Progress
) -> Iterator[Connection]:
    """The robot that was found, logged in to.

    Its key is compared with those in the project; outside of projects, with those of the robots that this user has met.

    :raises HostKeyError: when its key is not one that the project knows
    :raises ConnectionFailedError: when it does not let us in
    """
    keys = keys_of_robot(project, target, found)
    with progress.phase("connect") as phase:
        connection = connect(
            found.address,
            keys,
            connected=found.connected,
            accepted_key=choice.accepted_key,
            robot_name=choice.robot_name,
            credentials=choice.credentials,
        )
        recognized = connection.recognized
        phase.detail = "its key is the known one"
        if recognized.new_for is not None:
            phase.detail = f"a key not seen before, now pinned for {recognized.new_for}"
        if recognized.name:
            phase.detail += f" ({recognized.name})"
    if recognized.new_for is not None:
        progress.note(f"  its key: {connection.key.fingerprint} ({connection.key.kind})")
    with connection:
        yield connection


@contextmanager
def agent_on(connection: Connection, progress: Progress, modules: Sequence[str] = ()) -> Iterator[Robot]:
    """The agent, started on the robot; ended again.

    :param modules: the robot's facts will say which of these its Python cannot find
    """
    with progress.phase("look") as phase:
        try:
            robot = Robot.start(connection, hello={"modules": modules} if modules else None)
        except NoPythonError as error:
            raise RobotWithoutPython(connection).refusal(error) from error
        facts = robot.facts
        phase.detail = f"wpilib {facts.wpilib or 'missing'}, image {facts.image or 'unknown'}"
    try:
        with told_what_is_so(robot):
            yield robot
    finally:
        robot.close()


@contextmanager
def robot_of(
    project: Project | None, target: Target, choice: RobotChoice, progress: Progress
) -> Iterator[tuple[Connection, Robot]]:
    """All of the way."""
    found = find(target, choice, progress)
    with connected(project, target, found, choice, progress) as connection, agent_on(connection, progress) as robot:
        yield connection, robot


def address_to_follow(target: Target, choice: RobotChoice, progress: Progress) -> Address:
    """Where a robot's console is: an address that was named is believed, since the robot may be starting."""
    if target.robot is not None:
        return parse_address(target.robot)
    found = find(target, choice, progress)
    host = str(found.connected.getpeername()[0])
    found.connected.close()
    return Address(host)
