"""Deploys to look-alikes of each controller over a real SSH server: the program starts after any interruption."""

from __future__ import annotations

import contextlib
import functools
import random
from collections.abc import Generator
from pathlib import Path

import pytest
from conftest import sampled
from roborio import PATIENCE, Roborio, require_roborio
from roborio.computer import Computer
from roborio.local import LocalRobot, project_of
from roborio.ssh import SshConnection
from systemcore import Systemcore, require_systemcore

from pyfrc_core.deploy.agent_client import AgentClient, Deployed, DeployRequest, Watched
from pyfrc_core.deploy.connection import connect
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import ConnectionFailedError, RefusedError
from pyfrc_core.deploy.host_keys import HostKeys
from pyfrc_core.deploy.login import Credentials
from pyfrc_core.deploy.manifest import Manifest
from pyfrc_core.deploy.targets import AdministratorTask
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE

pytestmark = pytest.mark.bare

ROBOT = """\
import wpilib

print("this is {name}")


class Robot(wpilib.TimedRobot):
    {body}
"""
CRASHING = 'def __init__(self): raise RuntimeError("no such motor")'


def program(directory: Path, name: str, body: str = "pass", **files: str | bytes) -> Manifest:
    return project_of(directory / name, {"robot.py": ROBOT.format(name=name, body=body), **files})


@pytest.fixture
def roborio() -> Generator[Roborio]:
    require_roborio()
    with Roborio() as roborio:
        yield roborio


@pytest.fixture
def systemcore() -> Generator[Systemcore]:
    require_systemcore()
    with Systemcore() as systemcore:
        yield systemcore


Kind = type[Roborio] | type[Systemcore]


@pytest.fixture(params=sampled([Roborio, Systemcore], Roborio), ids=lambda kind: kind.controller.name)
def kind(request: pytest.FixtureRequest) -> Kind:
    if request.param is Roborio:
        require_roborio()
    else:
        require_systemcore()
    return request.param


@pytest.fixture
def computer(kind: Kind) -> Generator[Computer]:
    with kind() as computer:
        yield computer


@contextlib.contextmanager
def agent(computer: Computer, user: str | None = None) -> Generator[AgentClient]:
    """An agent on it."""
    computer.wait_for_end_of_deploy()  # the one before
    with SshConnection(computer.host, computer.port, user, computer.controller) as connection:
        robot = AgentClient.start(connection)
        try:
            yield robot
        finally:
            robot.close()


def deploy(computer: Computer, project: Manifest, user: str | None = None) -> Deployed:
    with agent(computer, user) as robot:
        return robot.deploy(project, DeployRequest("robot.py", {"deploy-host": "here"}))


def started(robot: AgentClient, seconds: float = PATIENCE) -> Watched:
    robot.restart()
    return robot.watch(seconds)


def test_a_program_is_deployed_and_runs(computer: Computer, tmp_path: Path) -> None:
    project, layout = program(tmp_path, "first", **{"Ünd so weiter/it's.txt": "x"}), computer.controller.layout
    with agent(computer) as robot:
        facts = robot.facts
        assert (facts.not_controller, facts.user) == (None, layout.user)
        assert (facts.current, facts.command, facts.running, facts.releases) == (None, None, False, ())
        assert robot.deploy(project, DeployRequest("robot.py", {"git-hash": "1234"})).release == 1
        printed: list[str] = []
        robot.restart()
        watched = robot.watch(PATIENCE, printed.append)
        assert watched.alive
        assert watched.started
        assert "this is first\n" in watched.output
        assert watched.output == "".join(printed)
        facts = robot.info()
        assert (facts.current, facts.running, facts.deploy_json) == (1, True, {"git-hash": "1234"})
    for path in (layout.code, f"{layout.home}/{layout.command}"):
        assert computer.run("stat", "-Lc", "%U:%G", path).stdout == f"{layout.owner}\n"
    assert (computer.home / layout.command).stat().st_mode & 0o777 == layout.command_mode
    computer.power_off()
    computer.power_on()
    computer.said("this is first")


def test_the_administrator_deploys_for_the_program_s_user(roborio: Roborio, tmp_path: Path) -> None:
    deploy(roborio, program(tmp_path, "first"), user="admin")
    assert roborio.run("find", "/home/lvuser", "!", "-user", "lvuser").stdout == ""


@pytest.mark.slow
def test_a_program_that_crashes_immediately_is_reported_with_its_traceback(
    systemcore: Systemcore, tmp_path: Path
) -> None:
    """On a roboRIO, the command shows it (`test_deploy_command`)."""
    with agent(systemcore) as robot:
        robot.deploy(program(tmp_path, "good"), DeployRequest("robot.py", {}))
        assert started(robot).alive
        robot.deploy(program(tmp_path, "bad", CRASHING), DeployRequest("robot.py", {}, debug=True))
        watched = started(robot)
        assert not watched.alive
        assert not watched.started
        assert watched.traceback is not None
        assert watched.traceback.splitlines()[0] == "Traceback (most recent call last):"
        assert f'File "{systemcore.controller.layout.code}/robot.py", line 7, in __init__' in watched.traceback
        assert watched.traceback.endswith("\nRuntimeError: no such motor")
        assert robot.rollback().release.number == 1
        watched = started(robot)
        assert watched.started
        assert watched.traceback is None


@pytest.mark.slow
def test_a_full_disk(tmp_path: Path) -> None:
    require_roborio()
    old = program(tmp_path, "old", **{"data.bin": b"1" * 500_000})
    large = program(tmp_path, "large", **{f"{number}.bin": b"%d" % number * 500_000 for number in range(8)})
    with Roborio(disk_size="3m") as computer:
        disk = LocalRobot(computer.disk, computer.controller)
        deploy(computer, old)
        before = disk.startable()
        with pytest.raises(RefusedError, match=r"the robot's disk is full: 4,\d{3},\d{3} bytes are needed") as caught:
            deploy(computer, large)
        assert "old logs" in str(caught.value)
        assert disk.startable() == before
        # The program fills it while the deploy goes on.
        small = program(tmp_path, "small", **{"data.bin": random.Random(2).randbytes(500_000)})
        filling = []

        def fill(phase: str, done: int, total: int) -> None:
            if not filling:
                filling.append(
                    computer.run(
                        "sh",
                        "-c",
                        f"head -c 4000000 /dev/zero > {computer.home_directory}/logs.bin",
                        user=computer.user,
                    )
                )

        with agent(computer) as robot:
            with pytest.raises(RefusedError, match="the robot's disk is full"):
                robot.deploy(small, DeployRequest("robot.py", {}), fill)
            assert disk.startable() == before
            assert started(robot).started
            computer.run("rm", f"{computer.home_directory}/logs.bin")
            robot.deploy(small, DeployRequest("robot.py", {}))
            assert "this is small" in started(robot).output


def test_after_a_crash_loop_the_next_program_starts(systemcore: Systemcore, tmp_path: Path) -> None:
    """systemd refuses to start a service again that was started five times within ten seconds."""
    with agent(systemcore) as robot:
        robot.deploy(program(tmp_path, "good"), DeployRequest("robot.py", {}))
        assert started(robot).started
        robot.deploy(program(tmp_path, "bad", CRASHING), DeployRequest("robot.py", {}))
        assert not started(robot).alive
        # The journal says so already: at first, there was no program to start.
        while "failed" not in systemcore.run("/usr/local/bin/systemctl", "is-active", "robot").stderr:
            pass
        assert systemcore.run("/usr/local/bin/systemctl", "start", "robot").returncode == 1
        robot.rollback()
        assert started(robot).started


def test_a_changed_password_is_asked_for_once_and_counts_for_the_whole_command(tmp_path: Path) -> None:
    require_systemcore()
    asked: list[str] = []

    def ask(robot: str) -> str:
        asked.append(robot)
        return "secret"

    with Systemcore(password="secret") as computer:
        address = Address(computer.host, computer.port)
        keys = HostKeys(tmp_path).of_robot(address, SYSTEMCORE)
        with pytest.raises(
            ConnectionFailedError, match="refuses systemcore with the password systemcore, which is the"
        ):
            connect(address, SYSTEMCORE, keys)
        assert keys.known() == [], "an unknown key is pinned only after the login"
        with connect(address, SYSTEMCORE, keys, credentials=Credentials(ask_password=functools.cache(ask))) as robot:
            assert robot.administer(AdministratorTask("sudo -n id", "", "")) is None
        assert asked == [f"systemcore@{address} (its key: {robot.key.fingerprint})"]
        with pytest.raises(ConnectionFailedError, match="with this password, and with the default one"):
            connect(address, SYSTEMCORE, keys, credentials=Credentials(ask_password=lambda robot: "wrong"))
    assert not [file for file in tmp_path.rglob("*") if file.is_file() and b"secret" in file.read_bytes()]
