"""Installing the project's packages on the robot, as its lock says: at first with Python, later only what changed.

An environment is made beside the current one, and the agent of the deploy runs in it. So all checks before a deploy are
about the Python that the program will start with. The deploy's switch selects it (`agent.environments`).
"""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..project import Project
from ..season import CURRENT
from ..sync import Lock, cached_file, load_lock, lock_file_of
from ..terminal_text import one_line
from ..wheel_files import WheelError, open_wheel
from ..wording import counted
from .connection import Connection, connection_lost
from .errors import DeployError, NoPythonError, OtherComputerError, RefusedError
from .manifest import Entry, Manifest
from .progress import DeployProgress, Phase
from .robot_checks import python_problem, refuse_installation
from .targets import ControllerKind

if TYPE_CHECKING:
    from .agent_client import AgentClient
    from .facts import RobotFacts

#: The version of how environments are made; it is part of their names.
_FORMAT = "2"
_NAME_LENGTH = 16
_CHUNK_BYTES = 1 << 16
_UNPACK_SECONDS = 600.0


@dataclass(frozen=True)
class Environment:
    """The environment on the robot that a project's lock asks for.

    :param lock:       its Python and packages
    :param controller: of the robot
    """

    lock: Lock
    controller: ControllerKind

    @property
    def name(self) -> str:
        """Its name on the robot: the same files in the same order give the same name."""
        files = [f"{each.sha256} {each.file}" for each in self.lock.packages]
        text = "\n".join([_FORMAT, self.lock.python.sha256, *files])
        return hashlib.sha256(text.encode()).hexdigest()[:_NAME_LENGTH]

    @property
    def python_name(self) -> str:
        """A name for its Python on the robot."""
        return self.lock.python.sha256[:_NAME_LENGTH]

    @property
    def python(self) -> str:
        """The path of its Python on the robot."""
        if self.controller.install_python.is_system:
            return self.controller.python
        return f"{self.controller.layout.home}/.pyfrc/pythons/{self.python_name}/bin/python3"

    @cached_property
    def wheels(self) -> Manifest:
        """Its packages' files on this computer.

        :raises NotSyncedError: if they are not here
        """
        packages = [(each, cached_file(each, CURRENT)) for each in self.lock.packages]
        return Manifest(tuple(Entry(each.file, each.size, each.sha256, False, file) for each, file in packages))

    def is_met_by(self, facts: RobotFacts) -> bool:
        """Return whether the robot has all of it already, in this environment or in another tool's."""
        same = facts.python == self.lock.python.version
        if self.controller.install_python.is_system:  # which is replaced by no newer one: the old program needs it
            same = python_problem(facts.python, str(CURRENT.year)) is None
        packages = {each.name: each.version for each in self.lock.packages}
        same = same and facts.packages.items() >= packages.items()
        return facts.environment == self.name or (facts.environment is None and same)


def wanted_environment(project: Project, controller: ControllerKind) -> Environment | None:
    """Return the environment that the project's lock asks for, or None without a lock.

    :raises SettingsError: if the lock is damaged, or of another season
    """
    lock = load_lock(lock_file_of(project), CURRENT)
    return None if lock is None else Environment(lock, controller)


def start_agent(
    connection: Connection, wanted: Environment | None, hello: Mapping[str, Any] | None, reinstall: bool = False
) -> AgentClient | None:
    """Start the agent: in the wanted environment, if that is there. Return None if it has to be installed with Python.

    :param reinstall: start it outside of the environment, which may be damaged
    :raises NoPythonError: if the robot has no Python, and no environment is wanted
    """
    from .agent_client import AgentClient

    if wanted is None:
        return AgentClient.start(connection, hello=hello, python=connection.python())
    with contextlib.suppress(NoPythonError):
        python = wanted.python if reinstall else connection.python(wanted.name)
        return AgentClient.start(connection, hello=hello, python=python)
    return None


def install(
    connection: Connection,
    robot: AgentClient | None,
    wanted: Environment,
    progress: DeployProgress,
    hello: Mapping[str, Any] | None,
) -> AgentClient:
    """Install an environment, or replace its damaged files, and start the agent in it.

    :param robot: the agent that runs in another Python, which then ends; None without one
    :raises RefusedError: if the robot has another problem, which an installation does not solve
    :raises NotSyncedError: if this computer does not have the files
    """
    try:
        refuse_installation(connection, None if robot is None else robot.facts)
        with progress.phase("install") as phase:
            robot = _install(connection, robot, wanted, phase)
    finally:
        if robot is not None:
            robot.close()
    robot = start_agent(connection, wanted, hello)
    if robot is None or robot.facts.environment != wanted.name:
        raise OtherComputerError(
            "another computer has changed the robot's packages meanwhile",
            where=str(connection.address),
            remedy="Run the command again.",
        )
    return robot


def _install(connection: Connection, robot: AgentClient | None, wanted: Environment, phase: Phase) -> AgentClient:
    from .agent_client import AgentClient

    wheels = wanted.wheels  # first: all of them have to be here
    installer, sent_python = wanted.controller.install_python, False
    if robot is None or not installer.is_system:
        phase.doing(str(wanted.lock.python))
        with contextlib.ExitStack() as stack:
            user = connection
            if installer.user != wanted.controller.layout.user:
                user = stack.enter_context(connection.as_user(installer.user))
            then = wheels.total_bytes + sum(map(_unpacked_size, wheels.entries)) if robot is None else 0
            sent_python = _send_python(user, wanted, cached_file(wanted.lock.python, CURRENT), then, phase)
    if robot is None:
        robot = AgentClient.start(connection, python=wanted.python)
    install_packages(robot, wanted, phase)
    if sent_python:
        phase.detail = f"{wanted.lock.python}, {phase.detail}"
    return robot


def install_packages(robot: AgentClient, wanted: Environment, phase: Phase) -> None:
    """Make an environment on a robot that has its Python, and replace damaged files of all environments."""
    wheels, python = wanted.wheels, None if wanted.controller.install_python.is_system else wanted.python_name
    sent = robot.install(wanted.name, python, wheels, [_unpacked_size(each) for each in wheels.entries], phase.work)
    phase.detail = f"{counted(sent, 'package')} of {len(wheels.entries)} sent"


def _unpacked_size(wheel: Entry) -> int:
    try:
        with open_wheel(wheel.file, wheel.path) as archive:
            # Blocks of 4096 bytes, and compiled files of about the same size.
            return sum(
                (each.file_size // 4096 + 1) * 4096 * (2 if each.filename.endswith(".py") else 1)
                for each in archive.infolist()
            )
    except WheelError as error:
        raise RefusedError(str(error), where=wheel.file, remedy="Remove it; then: pyfrc sync") from error


def _send_python(connection: Connection, wanted: Environment, archive: Path, then: int, phase: Phase) -> bool:
    """Send the robot's Python, unless it is there. Return whether it was sent.

    :param then: bytes that the packages need on its disk afterwards
    :raises RefusedError: if the robot's disk is too full
    :raises DeployError: if it cannot be unpacked
    """
    size, installer = archive.stat().st_size, wanted.controller.install_python
    needed = installer.needed(archive) + then
    script = installer.script.format(
        name=wanted.python_name, size=size, kilobytes=needed // 1024, sha256=wanted.lock.python.sha256
    )
    with connection.opened(script) as channel:
        try:
            reply = channel.makefile("r").readline().strip()
            if reply == "there":
                return False
            if reply.startswith("full "):
                raise RefusedError(
                    f"the robot's disk is too full to install Python and packages: {needed // 1000:,} kB are needed, "
                    f"{one_line(reply)[5:]} kB are free",
                    where=str(connection.address),
                    remedy="Remove old logs from the robot. Nothing was changed.",
                )
            done = 0
            with archive.open("rb") as stream:
                while reply == "send" and (chunk := stream.read(_CHUNK_BYTES)):
                    channel.sendall(chunk)
                    done += len(chunk)
                    phase.bytes(done, size)
            channel.shutdown_write()
            known = channel.status_event.wait(_UNPACK_SECONDS)
            status = channel.recv_exit_status() if known else -1
            said = channel.recv_stderr(4096).decode(errors="replace").strip().splitlines()[-1:] if known else []
        except (OSError, EOFError) as error:
            raise connection_lost(connection.address, error) from error
    if status != 0:
        raise DeployError(
            f"Python could not be installed on the robot: {one_line(''.join(said)) or f'exit code {status}'}",
            where=str(connection.address),
            remedy="The robot is as it was. Run the command again.",
        )
    return True
