"""The way to a robot: whose it is, where it answers, the connection, and the agent on it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from ..errors import UsageError
from ..project import Project
from .connection import Connection, connect, load_in_background
from .discovery import Address, Found, addresses_of, find_robot, parse_address
from .host_keys import HostKeys
from .progress import Progress, Questions
from .robot import Robot
from .standing import told_what_is_so
from .team import Target, find_target


@dataclass(frozen=True)
class RobotChoice:
    """Which robot the command names, if it does.

    :param robot: its address, as ``HOST`` or ``HOST:PORT``
    :param resolve: whether names may be looked up
    :param accepted_key: the fingerprint of a changed host key that the user accepts
    """

    robot: str | None = None
    team: int | None = None
    resolve: bool = True
    accepted_key: str | None = None

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
            candidates = [(parse_address(target.robot), f"by {target.source}")]
            found = find_robot(candidates, target.robot, take_its_robot=False)
        else:
            assert target.team is not None
            whose = f"team {target.team} (by {target.source})"
            found = find_robot(addresses_of(target.team, choice.resolve), whose)
        phase.detail = f"{found.address} ({found.kind})"
    return found


def keys_known_to(project: Project | None) -> HostKeys:
    """The keys of a project's robots; outside of projects, those of the robots that this user has met."""
    return HostKeys.of_user() if project is None else HostKeys(project.pyproject.parent)


@contextmanager
def connected(project: Project | None, found: Found, choice: RobotChoice, progress: Progress) -> Iterator[Connection]:
    """The robot that was found, logged in to.

    :raises HostKeyError: when its key is not the one that the project knows
    :raises ConnectionFailedError: when it does not let us in
    """
    keys = keys_known_to(project)
    with progress.phase("connect") as phase:
        connection = connect(found.address, keys, connected=found.connected, accepted_key=choice.accepted_key)
        phase.detail = "its key is the known one"
        if connection.new_key is not None:
            phase.detail = "a key not seen before, now pinned"
    if connection.new_key is not None:
        progress.note(f"  its key: {connection.new_key.fingerprint} ({connection.new_key.kind})")
    with connection:
        yield connection


@contextmanager
def agent_on(connection: Connection, progress: Progress) -> Iterator[Robot]:
    """The agent, started on the robot; ended again."""
    with progress.phase("look") as phase:
        robot = Robot.start(connection)
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
    with connected(project, found, choice, progress) as connection, agent_on(connection, progress) as robot:
        yield connection, robot


def address_to_follow(target: Target, choice: RobotChoice, progress: Progress) -> Address:
    """Where a robot's console is: an address that was named is believed, since the robot may be starting."""
    if target.robot is not None:
        return parse_address(target.robot)
    found = find(target, choice, progress)
    host = str(found.connected.getpeername()[0])
    found.connected.close()
    return Address(host)
