"""Controllers: only `deploy.targets` names them, and the agent works with the layout of any."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from core.agent_disk import AgentDisk
from loops import for_each

import pyfrc_core.deploy
from pyfrc_core.deploy import connection as connection_module
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.layout import Layout
from pyfrc_core.deploy.connection import VIRTUAL_ROBOT_GREETING, Connection
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import ConnectionFailedError
from pyfrc_core.deploy.targets import CONTROLLERS, MAX_TEAM, ControllerKind, team_of_host
from pyfrc_core.deploy.targets.controller import remove_remains
from pyfrc_core.deploy.targets.roborio import ROBORIO

#: One user, one file with the start command, a service manager.
ONE_USER = Layout(
    name="Other ControllerKind",
    user="pilot",
    owner="pilot:pilot",
    administrator="pilot",
    home="/srv/pilot",
    code="/srv/pilot/program",
    start="/srv/pilot/venv/bin/python3 -O -m robotpy --main {main} run\n",
    start_debug="/srv/pilot/venv/bin/python3 -m robotpy --main {main} -v run\n",
    command="start",
    debug_command="",
    debug_flag="",
    stop=("/usr/bin/service", "stop", "robot"),
    restart=("/usr/bin/service", "restart", "robot"),
    stopper="service",
    profiles=(),
    texts={},
    python="/srv/pilot/venv/bin/python3",
)
LAYOUTS = [*(each.layout for each in CONTROLLERS), ONE_USER]


def test_no_other_module_names_a_controller() -> None:
    directory = Path(pyfrc_core.deploy.__file__).parent
    names = re.compile(r"roborio|systemcore|lvuser|frcKillRobot|natinst|/usr/local/frc|/home/", re.IGNORECASE)
    allowed = {directory / "__init__.py"}  # the room's description names its controllers
    modules = [file for file in directory.rglob("*.py") if file not in allowed and "targets" not in file.parts]
    assert [file.name for file in modules if names.search(file.read_text("utf-8"))] == []


@pytest.fixture(params=LAYOUTS, ids=lambda layout: layout.name)
def robot(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AgentDisk:
    monkeypatch.setattr(RealRobot, "processes", lambda robot: set())
    return AgentDisk(tmp_path / "disk", request.param)


def test_deploys_and_going_back(robot: AgentDisk) -> None:
    code = Path(robot.places.layout.code).name
    robot.deploy({"robot.py": "# 1\n"}, "# 1\n")
    assert robot.startable() == f"{code}/robot.py: # 1"
    assert "-v" not in robot.places.start_command()
    robot.deploy({"robot.py": "# 2\n"}, "# 2\n", debug=True)
    assert robot.startable() == f"{code}/robot.py: # 2"
    assert "-v" in robot.places.start_command()
    robot.ask({"op": "rollback", "release": None})
    assert robot.startable() == f"{code}/robot.py: # 1"
    assert "-v" not in robot.places.start_command()


def test_the_program_is_stopped_by_the_controllers_command(robot: AgentDisk) -> None:
    robot.deploy({"robot.py": "# 1\n"}, "# 1\n")
    layout, calls = robot.places.layout, robot.root / "calls"
    command = robot.places.of(layout.restart[0])
    (missing,) = robot.ask({"op": "restart"})
    assert layout.restart[0] in missing["message"]
    command.parent.mkdir(parents=True)
    command.write_text(f'#!/bin/sh\nprintf "%s\\n" "$*" >> {calls}\n')
    command.chmod(0o755)
    assert robot.ask({"op": "restart"}) == [{"done": {"survived": False}}]
    assert robot.ask({"op": "undeploy"}) == [{"done": {"removed": True}}]
    assert calls.read_text().splitlines() == [" ".join(layout.restart[1:]), " ".join(layout.stop[1:])]
    assert robot.startable() == "nothing"


@pytest.mark.skipif(sys.platform != "linux", reason="it asks /proc which processes run")
def test_what_an_interrupted_installation_leaves_is_removed(tmp_path: Path) -> None:
    place = tmp_path / "installing"
    place.mkdir()
    with subprocess.Popen(["sh", "-c", f"read line # {place}"], stdin=subprocess.PIPE) as running:
        # Its number may be another process's now, such as ours.
        ours = f"{os.getpid()}.ipk", f"{os.getpid()}.tmp/opkg-1/file"
        for name in (f"{running.pid}.ipk", *ours, "0123456789abcdef/x"):
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).touch()
        subprocess.run(["sh", "-c", remove_remains(str(place))], check=True)
        assert sorted(each.name for each in place.iterdir()) == sorted(["0123456789abcdef", f"{running.pid}.ipk"])
        running.communicate(b"")
    subprocess.run(["sh", "-c", remove_remains(str(place))], check=True)
    assert [each.name for each in place.iterdir()] == ["0123456789abcdef"]


@pytest.mark.skipif(sys.platform != "linux", reason="a robot runs Linux")
@pytest.mark.parametrize("controller", CONTROLLERS, ids=lambda each: each.name)
def test_a_lost_connection_leaves_nothing_of_an_installation(controller: ControllerKind, tmp_path: Path) -> None:
    place, installer = tmp_path / "installing", controller.install_python
    script = installer.script.format(name="0123456789abcdef", size=1000, kilobytes=1, sha256="0" * 64)
    script = script.replace(controller.layout.installing, str(place))
    done = subprocess.run(["sh", "-c", script], input=b"too little", capture_output=True, check=False)
    assert done.stdout == b"send\n"
    assert done.returncode != 0
    assert list(place.iterdir()) == []


@pytest.mark.skipif(sys.platform != "linux", reason="a robot runs Linux")
def test_which_python_an_agent_runs_in(tmp_path: Path) -> None:
    """That of the wanted environment, if it is complete; else the one of the start command, if it is there."""
    layout = ROBORIO.layout._replace(home=str(tmp_path), python=str(tmp_path / "system"))
    controller = replace(ROBORIO, layout=layout, check_python="")
    current, wanted = (tmp_path / f".pyfrc/environments/{name * 16}" for name in "ab")
    for place in (tmp_path / "system", current / "bin/python3", wanted / "bin/python3"):
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(f"#!/bin/sh\necho {place.relative_to(tmp_path)} $1\n")
        place.chmod(0o755)

    def runs(environment: str | None, is_virtual: bool = False) -> str:
        greeting = VIRTUAL_ROBOT_GREETING if is_virtual else "SSH-2.0-OpenSSH"
        transport: Any = SimpleNamespace(remote_version=f"{greeting} x=1")
        connection = Connection(transport, Address("10.0.0.2"), controller, *(3 * [None]))  # type: ignore[arg-type]
        command = f"{connection.python(environment)} words"
        return subprocess.run(["sh", "-c", command], check=True, capture_output=True, text=True).stdout

    assert runs(None) == runs("b" * 16) == "system words\n"
    (tmp_path / layout.command).write_text(f"env A=b {current}/bin/python3 -u -m robotpy\n")
    assert runs(None) == runs("b" * 16) == f".pyfrc/environments/{'a' * 16}/bin/python3 words\n"
    (wanted / "environment.json").touch()
    assert runs("b" * 16) == f".pyfrc/environments/{'b' * 16}/bin/python3 words\n"
    (current / "bin/python3").unlink()
    assert runs(None) == "system words\n"
    assert runs("b" * 16, is_virtual=True) == "system words\n", "its program runs in this computer's environment"


@for_each("controller", CONTROLLERS)
def test_remains_are_reported(controller: ControllerKind, tmp_path: Path) -> None:
    robot = AgentDisk(tmp_path / "disk", controller.layout)
    place = robot.places.of(controller.layout.installing)
    (place / "0123456789abcdef").mkdir(parents=True)
    for remains in (False, True):
        (facts,) = robot.ask({"op": "info"})
        assert facts["done"]["remains"] is remains
        (place / "123.ipk").touch()


@for_each("controller", CONTROLLERS)
def test_the_hosts_of_a_team_belong_to_it(controller: ControllerKind) -> None:
    hosts = [host for host, _ in controller.addresses(1234)]
    teams = {host: controller.team_of_host(host) for host in hosts}
    assert {host for host in hosts if teams[host] is None} == set(controller.shared_hosts)
    assert set(teams.values()) <= {1234, None}


def test_the_team_of_an_address() -> None:
    teams = {"10.0.1.2": 1, "10.255.99.2": MAX_TEAM, "roboRIO-254-FRC.local": 254, "roborio-1-frc": 1}
    nothing = ("10.0.0.2", "10.12.34.3", "roborio-0-frc", "roborio-25600-frc", "172.22.11.2", "robot.local")
    assert {host: team_of_host(host) for host in (*teams, *nothing)} == {**teams, **dict.fromkeys(nothing)}


def test_a_channel_is_closed_whatever_happens(monkeypatch: pytest.MonkeyPatch) -> None:
    events: list[str] = []
    channel = SimpleNamespace(
        settimeout=lambda seconds: None, exec_command=events.append, close=lambda: events.append("closed")
    )
    transport: Any = SimpleNamespace(open_session=lambda timeout: channel, is_active=lambda: True)
    connection = Connection(transport, Address("10.0.0.2"), ROBORIO, *(3 * [None]))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="odd"), connection.opened("command"):
        raise ValueError("odd")
    assert events == ["command", "closed"]
    transport.is_active = lambda: False
    channel.exec_command = lambda command: channel.missing
    with pytest.raises(ConnectionFailedError, match="the connection to the robot was lost"):
        connection.open("command")
    transport.is_active = lambda: True
    with pytest.raises(ConnectionFailedError, match="the robot does not run commands over SSH: "):
        connection.open("command")
    monkeypatch.setattr(connection_module, "STEP_SECONDS", 0.01)
    is_closed = threading.Event()
    channel.close = is_closed.set
    channel.exec_command = lambda command: is_closed.wait(60) and channel.missing
    with pytest.raises(ConnectionFailedError, match="the robot does not run commands over SSH: "):
        connection.open("command that is never responded to")
