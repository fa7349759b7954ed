"""Finding the robot, connecting to it, and starting the agent on it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from .connection import Connection, connect, load_in_background
from .discovery import Address, FoundRobot, addresses_of, find_robot, parse_address
from .errors import NoPythonError
from .host_keys import HostKeys, RobotKeys
from .progress import DeployProgress
from .recovery_hints import explain_interruption
from .team import RobotChoice, RobotTarget

if TYPE_CHECKING:
    from .agent_client import AgentClient
    from .installing import Environment


def find(target: RobotTarget, choice: RobotChoice, progress: DeployProgress) -> FoundRobot:
    """Find the robot, and return it with an open socket.

    :raises RobotNotFoundError: with all failed attempts
    :raises OnTheFieldError: if the Driver Station is connected to a competition field
    """
    load_in_background()
    with progress.phase("find") as phase:
        found = search(target, choice.resolve)
        phase.detail = f"{found.address} ({found.kind})"
    return found


def search(target: RobotTarget, resolve: bool = True) -> FoundRobot:
    """Find the robot, and return it with an open socket.

    :param resolve: whether host names may be resolved
    :raises RobotNotFoundError: with all failed attempts
    :raises OnTheFieldError: if the Driver Station is connected to a competition field
    """
    if target.robot is not None:
        address = parse_address(target.robot)
        return find_robot([(address, f"by {target.source}")], str(address), target.controller, take_its_robot=False)
    assert target.team is not None
    candidates = addresses_of(target.team, target.controller, resolve)
    return find_robot(candidates, f"team {target.team} (by {target.source})", target.controller)


def load_robot_keys(target: RobotTarget, address: Address) -> RobotKeys:
    """Return the known host keys of the robot: of the project, or of this user outside of a project."""
    keys = HostKeys.of_this_user() if target.keys_in is None else HostKeys(target.keys_in)
    return keys.of_robot(address, target.controller, target.team, target.project_team)


@contextmanager
def connected(
    target: RobotTarget, found: FoundRobot, choice: RobotChoice, progress: DeployProgress
) -> Iterator[Connection]:
    """Log in to the robot that was found, and disconnect after the ``with`` block.

    Its host key is compared with the project's known keys or, outside of a project, with this user's.

    :raises HostKeyError: if the key is not known
    :raises ConnectionFailedError: if the login fails
    """
    with progress.phase("connect") as phase:
        connection = connect(
            found.address,
            target.controller,
            load_robot_keys(target, found.address),
            connected=found.connected,
            accepted_key=choice.accepted_key,
            robot_name=choice.robot_name,
            credentials=choice.credentials,
        )
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


def reconnected(target: RobotTarget, address: Address, choice: RobotChoice) -> Connection:
    """Log in again to a robot whose key is pinned.

    :raises HostKeyError: if another robot is at the address now
    :raises ConnectionFailedError: if the login fails
    """
    keys = load_robot_keys(target, address)
    return connect(address, target.controller, keys, pin=False, credentials=choice.credentials)


@contextmanager
def connected_agent(
    target: RobotTarget,
    choice: RobotChoice,
    progress: DeployProgress,
    modules: Callable[[], Sequence[str]] = tuple,
    wanted: Environment | None = None,
    reinstall: bool = False,
) -> Iterator[tuple[Connection, AgentClient]]:
    """Find the robot, connect to it and start the agent. The agent ends after the ``with`` block.

    :param modules: returns the modules to look for in the robot's Python
    :param wanted: an environment, which is installed if the robot does not have all of it
    :param reinstall: compare the files of that environment, and send those again that are damaged
    :raises RefusedError: if there is no Python on the robot
    """
    found = find(target, choice, progress)
    with connected(target, found, choice, progress) as connection:
        robot = _start_agent(connection, progress, modules(), wanted, reinstall)
        try:
            with explain_interruption(robot):
                yield connection, robot
        finally:
            robot.close()


def _start_agent(
    connection: Connection,
    progress: DeployProgress,
    modules: Sequence[str],
    wanted: Environment | None,
    reinstall: bool,
) -> AgentClient:
    from .installing import install, start_agent

    hello = {"modules": modules} if modules else None
    if connection.is_virtual_robot:
        wanted = None  # its program runs in this computer's environment
    with progress.phase("look") as phase:
        try:
            robot = start_agent(connection, wanted, hello, reinstall)
        except NoPythonError as error:
            from .robot_checks import RobotWithoutPython  # not before, since it is rare

            raise RobotWithoutPython(connection).refusal(error) from error
        phase.detail = "there is no Python on it yet"
        if robot is not None:
            phase.detail = f"wpilib {robot.facts.wpilib or 'missing'}, image {robot.facts.image or 'unknown'}"
    if wanted is not None and (reinstall or robot is None or not wanted.is_met_by(robot.facts)):
        return install(connection, robot, wanted, progress, hello)
    assert robot is not None
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
