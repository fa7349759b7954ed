"""The agent's code that the robot keeps: used if the laptop would send the same, and no other user can write it."""

from __future__ import annotations

import hashlib
import json
import marshal
import os
import subprocess
import sys
import time
import zlib
from collections.abc import Callable, Generator
from importlib.util import MAGIC_NUMBER
from pathlib import Path

import pytest
from roborio import PATIENCE, Proxy, Roborio, require_roborio
from roborio.local import project_of
from roborio.ssh import SshConnection
from skips import require

from pyfrc_core.deploy.agent import wire
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.kept import keep
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.agent_client import AgentClient, DeployRequest
from pyfrc_core.deploy.agent_package import COMMAND, agent_hash, agent_package

HASH = b"0" * 64
#: An agent that prints where it comes from and its first message.
AGENT = "def main(source, first, code):\n    print(WHERE, first.decode(), len(code) > 0)"
NEED = wire.frame(wire.MESSAGE, zlib.compress(json.dumps({"need": "agent"}).encode()))

posix = pytest.mark.skipif(sys.platform == "win32", reason="a roboRIO has Linux")


def code(where: str, hashed: bytes = HASH, magic: bytes = MAGIC_NUMBER) -> bytes:
    modules = [("agent", compile(f"WHERE = {where!r}\n{AGENT}", "agent", "exec"))]
    return hashed + magic + marshal.dumps(modules)


@pytest.fixture
def paths(tmp_path: Path) -> RobotPaths:
    """A robot whose agent was kept."""
    paths = RobotPaths(str(tmp_path))
    paths.own.mkdir(parents=True)
    keep(paths, code("kept"))
    return paths


def load(paths: RobotPaths, user: int | None = None) -> bytes:
    """What an agent prints that is started on this robot; it is sent if it is requested, and not otherwise."""
    program = COMMAND.partition(" -c '")[2].removesuffix("'").replace("/home/lvuser/.pyfrc/agent", str(paths.agent))
    package = zlib.compress(json.dumps([["agent", f"WHERE = 'sent'\n{AGENT}"]]).encode())
    sent = HASH + b"%08d" % 5 + b"hello" + b"%08d" % len(package) + package
    done = subprocess.run(
        [sys.executable, "-I", "-c", program], input=sent, capture_output=True, timeout=60, check=True, user=user
    )
    return done.stdout.replace(b"\r\n", b"\n")


@posix
def test_what_was_kept_is_used(paths: RobotPaths) -> None:
    assert paths.agent.stat().st_mode & 0o777 == 0o600
    assert load(paths) == b"kept hello False\n"


def change(file: Path, at: int) -> None:
    content = bytearray(file.read_bytes())
    content[at] ^= 1
    file.write_bytes(content)


def linked(file: Path) -> None:
    file.rename(file.with_name("elsewhere"))
    file.symlink_to("elsewhere")


def a_pipe(file: Path) -> None:
    file.unlink()
    os.mkfifo(file)


def rewritten(content: bytes) -> Callable[[Path], object]:
    return lambda file: file.write_bytes(hashlib.sha256(content).digest() + content)


FAULTS: dict[str, Callable[[Path], object]] = {
    "absent": Path.unlink,
    "empty": lambda file: file.write_bytes(b""),
    "a changed checksum": lambda file: change(file, 0),
    "a changed hash": lambda file: change(file, 40),
    "changed code": lambda file: change(file, -9),
    "truncated": lambda file: os.truncate(file, file.stat().st_size - 1),
    "of another version": rewritten(code("kept", b"1" * 64)),
    "of another Python": rewritten(code("kept", magic=b"none")),
    "not code": rewritten(HASH + MAGIC_NUMBER + b"nothing"),
    "others may write": lambda file: file.chmod(0o602),
    "its group may write": lambda file: file.chmod(0o620),
    "a link": linked,
    "a directory": lambda file: (file.unlink(), file.mkdir()),
    "a pipe": a_pipe,
}


@posix
@pytest.mark.parametrize("fault", FAULTS)
def test_anything_else_is_not_used(paths: RobotPaths, fault: str) -> None:
    FAULTS[fault](paths.agent)
    assert load(paths) == NEED + b"sent hello True\n"


@posix
def test_another_users_file_is_not_used(paths: RobotPaths) -> None:
    """Neither the program's by the administrator, nor anybody else's by the program's user."""
    require("that another user's agent is not used", [] if os.geteuid() == 0 else ["root"])
    os.chown(paths.agent, 500, 500)
    assert load(paths) == NEED + b"sent hello True\n"


@posix
def test_keeping_it(paths: RobotPaths) -> None:
    keep(paths, b"")  # it was loaded from there
    assert load(paths) == b"kept hello False\n"
    keep(paths, code("kept again"))
    assert load(paths) == b"kept again hello False\n"
    assert [each.name for each in paths.own.iterdir()] == ["agent"]
    paths.agent.unlink()
    paths.agent.mkdir()
    keep(paths, code("not possible"))
    assert [each.name for each in paths.own.iterdir()] == ["agent"]


def test_nothing_is_kept_on_a_robot_without_releases(tmp_path: Path) -> None:
    paths = RobotPaths(str(tmp_path))
    keep(paths, code("kept"))
    assert list(tmp_path.iterdir()) == []


@posix
def test_a_recovery_removes_what_a_killed_agent_has_left(paths: RobotPaths) -> None:
    (paths.own / "agent-123").write_bytes(b"unfinished")
    Releases(paths, Activity(lambda **message: None)).recover()
    assert [each.name for each in paths.own.iterdir()] == ["agent"]
    assert load(paths) == b"kept hello False\n"


@pytest.fixture
def roborio() -> Generator[Roborio]:
    require_roborio()
    with Roborio() as roborio:
        yield roborio


def test_a_robot_is_sent_the_agent_once(roborio: Roborio, tmp_path: Path) -> None:
    project = project_of(tmp_path / "project", {"robot.py": "pass\n"})
    sent = []
    for _ in range(2):
        with Proxy((roborio.host, roborio.port)) as proxy, SshConnection(proxy.host, proxy.port) as connection:
            robot = AgentClient.start(connection)
            robot.deploy(project, DeployRequest("robot.py", {}))
            robot.close()
            _wait_until(lambda: (roborio.home / ".pyfrc/agent").exists())
            roborio.wait_for_end_of_deploy()
            sent.append(proxy.bytes_to_robot)
    assert sent[1] < sent[0] - len(agent_package()) / 2
    kept = (roborio.home / ".pyfrc/agent").read_bytes()
    assert kept[32:96] == agent_hash()
    assert (roborio.home / ".pyfrc/agent").stat().st_uid == 500
    with SshConnection(roborio.host, roborio.port) as connection:
        robot = AgentClient.start(connection)
        assert robot.facts.current == 1
        assert robot.undeploy()
        robot.close()
    assert list(roborio.home.iterdir()) == []


def _wait_until(is_so: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.02)
