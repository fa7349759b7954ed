"""Where `pyfrc view --robot` looks for a robot, and what it shows of the robot's output."""

from __future__ import annotations

import socket
import struct
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeProject
from loops import for_each
from network_robots import link_to, network_robot
from ports import lasting_port, refusing_port
from web_pages import served_source

from pyfrc_core.deploy.connection import VIRTUAL_ROBOT_GREETING
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.targets import controller_of
from pyfrc_core.errors import UsageError
from pyfrc_core.project import Project, find_project
from pyfrc_core.season import CURRENT
from pyfrc_core.sim.live.addresses import RobotAddresses, addresses_for
from pyfrc_core.sim.live.robot import LiveRobot

HERE = ("127.0.0.1", 5810)


def test_a_team_has_the_addresses_that_a_deploy_tries() -> None:
    where = addresses_for("1234", None)
    assert [host for host, _ in where.servers] == [host for host, _ in controller_of(CURRENT).addresses(1234)]
    assert {port for _, port in where.servers} == {5810}
    assert (where.whose, where.asks_driver_station) == ("team 1234", True)


def test_an_address_may_have_a_port() -> None:
    assert addresses_for("10.12.34.2", None).servers == (("10.12.34.2", 5810),)
    assert addresses_for("robot.local:5811", None).servers == (("robot.local", 5811),)
    assert not addresses_for("10.12.34.2", None).asks_driver_station


@pytest.mark.parametrize(
    ("files", "robot"),
    [
        ({}, None),
        ({"pyproject.toml": "[tool.pyfrc]\nteam = 254\n"}, "254"),
        ({".wpilib/wpilib_preferences.json": '{"robotHostname": "10.2.54.9"}'}, "10.2.54.9"),
    ],
    ids=["none", "team", "address"],
)
def test_without_an_address_it_is_the_projects_robot_or_this_computer(
    files: dict[str, str], robot: str | None, make_project: Any
) -> None:
    project = find_project(make_project({"robot.py": "", **files}).path)
    servers = () if robot is None else addresses_for(robot, None).servers
    assert addresses_for(None, project).servers == (*servers, HERE)
    assert addresses_for(None, None).servers == (HERE,)


@for_each(
    "given, error",
    [
        *((text, "is not an address of a robot") for text in ("foo..bar", "http://10.12.34.2", "my robot", "robot:x")),
        *((text, "is not a valid address") for text in ("10.0.0.300", "10.1.2", "1234:5810")),
        *((text, "a team's number is from 1 to 25599") for text in ("0", "99999")),
        ("match.wpilog", "--robot match.wpilog: this is a file, not an address"),
    ],
)
def test_what_cannot_be_an_address_is_refused(
    given: str, error: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "match.wpilog").touch()
    with pytest.raises(UsageError) as caught:
        addresses_for(given, None)
    assert error in str(caught.value)
    assert "--robot" in str(caught.value)
    assert "--team" not in str(caught.value)


def test_a_robot_that_is_not_there_is_explained_and_waited_for(make_project: MakeProject) -> None:
    made, port = make_project({"robot.py": ""}), lasting_port()
    with made.start("view", "--robot", f"127.0.0.1:{port}") as view:
        said = iter(view.stdout.readline, "")
        assert f"Looking for the robot at 127.0.0.1:{port}. " in next(line for line in said if "Looking" in line)
        why = next(line for line in said if "No robot yet" in line)
        assert why.startswith(
            f"No robot yet; still trying. 127.0.0.1:{port}: a computer is there, but no robot program"
        )
        with network_robot(made.path, port):
            assert next(line for line in said if "Connected" in line) == f"Connected to 127.0.0.1:{port}.\n"


def test_why_there_is_no_robot_is_on_the_page(tmp_path: Path) -> None:
    with refusing_port() as port:
        where = RobotAddresses("mine", (("127.0.0.1", port), ("no-such-robot.invalid", 5810)))
        with served_source(LiveRobot(Project(tmp_path / "robot.py"), where)) as there, there.page() as page:
            page.until(lambda: page.status.get("note"))
            note = page.status["note"]
            assert note.startswith(f"No robot yet; still trying. 127.0.0.1:{port}: a computer is there, ")
            assert "no-such-robot.invalid:5810: the name is not known here." in note


def test_a_robot_or_logs(make_project: Any) -> None:
    made = make_project({"a.wpilog": ""})
    for arguments, message in (
        ((), "nothing to show"),
        (("--robot", ""), "the address is empty"),
        (("--robot", "--page", "a.html"), "--robot shows a robot, and no logs"),
    ):
        result = made.run_here("view", *arguments)
        assert result.code == 2
        assert message in result.output


@contextmanager
def console_of(*lines: str) -> Iterator[Address]:
    """A robot's console, whose port is in the greeting of another one, as a virtual robot has it."""
    with socket.create_server(("127.0.0.1", 0)) as greeting, socket.create_server(("127.0.0.1", 0)) as console:

        def serve(server: socket.socket, data: bytes) -> None:
            held = []
            try:
                while True:
                    client, _ = server.accept()
                    client.sendall(data)
                    held.append(client)
            except OSError:  # it was closed
                for client in held:
                    client.close()

        frames = b"".join(
            struct.pack(">HBfH", 7 + len(line), 12, 1.5, number) + line.encode() for number, line in enumerate(lines)
        )
        port = console.getsockname()[1]
        for server, data in ((greeting, f"{VIRTUAL_ROBOT_GREETING} console={port}\r\n".encode()), (console, frames)):
            threading.Thread(target=serve, args=(server, data), daemon=True).start()
        yield Address("127.0.0.1", greeting.getsockname()[1])
        for server in (greeting, console):
            server.shutdown(socket.SHUT_RDWR)


def test_what_the_robot_prints_is_shown(tmp_path: Path) -> None:
    port = lasting_port()
    with network_robot(tmp_path, port), console_of("hello", "Warning: hot") as console:
        where = addresses_for(f"127.0.0.1:{port}", None)
        source = LiveRobot(Project(tmp_path / "robot.py"), where, lambda host: console)
        with served_source(source) as there, there.page() as page:
            page.until(lambda: any(line["text"] == "[1.50] Warning: hot" for line in page.console))
            assert any(line["text"] == "[1.50] hello" for line in page.console)


def test_a_robot_without_a_console_is_said_once(tmp_path: Path) -> None:
    port = lasting_port()
    with network_robot(tmp_path, port), link_to(port) as link, refusing_port() as silent:
        where = addresses_for(f"127.0.0.1:{link.port}", None)
        source = LiveRobot(Project(tmp_path / "robot.py"), where, lambda host: Address("127.0.0.1", silent))
        with served_source(source) as there, there.page() as page:

            def said(text: str) -> int:
                return sum(text in line["text"] for line in page.console)

            page.until(lambda: said("there is no console"))
            link.cut()
            page.until(lambda: said("was lost"))
            link.mend()
            page.until(lambda: said("Connected") == 2 and page.station["text"] != "No connection")
            assert said("there is no console") == 1
