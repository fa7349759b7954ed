"""The page of a robot on the network: a program with NetworkTables in another process, and a page without a browser."""

from __future__ import annotations

import gc
import struct
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic
from typing import Any
from urllib.parse import urlsplit

import pytest
from network_robots import AUTONOMOUS, DISABLED, TELEOP, WORD, NetworkRobot, link_to, network_robot
from ports import lasting_port
from roborio import require_roborio
from sim_robots import PATIENCE
from skips import missing_programs, require
from web_pages import Page, Served, served_source

from pyfrc_core.project import Project
from pyfrc_core.season import CURRENT
from pyfrc_core.sim.live.addresses import addresses_for
from pyfrc_core.sim.live.robot import LiveRobot
from pyfrc_core.wpi import network, network_client
from pyfrc_core.wpi.network_news import Connected, Received


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[NetworkRobot]:
    with network_robot(tmp_path, lasting_port()) as found:
        yield found


@contextmanager
def shown(directory: Path, port: int) -> Iterator[Served]:
    """Serve the page of the robot at a port of this computer. It has no console."""
    where = addresses_for(f"127.0.0.1:{port}", None)
    with served_source(LiveRobot(Project(directory / "robot.py"), where, lambda host: None)) as there:
        yield there


def curve(page: Page, path: str) -> list[Any]:
    """Return the values that a plot of the whole time has."""
    asked = {"from": 0, "to": 1000, "points": 1000}
    return page.ask(type="plot", paths=[path], **asked)["series"][path]["v"]  # type: ignore[no-any-return]


def test_values_types_structs_and_modes_are_shown(robot: NetworkRobot, tmp_path: Path) -> None:
    robot.set("/SmartDashboard/kP", "double", 0.5)
    robot.set("/SmartDashboard/names", "string[]", ["a", "b"])
    robot.set_data("/pose", "struct:Point", struct.pack("<dd", 1.5, 2.5))
    robot.set_data("/.schema/struct:Point", "structschema", b"double x;double y")
    with shown(tmp_path, robot.port) as there, there.page() as page:
        page.until(lambda: page.values.get("nt:/pose/y") == 2.5)
        assert page.values["nt:/SmartDashboard/kP"] == 0.5
        assert page.values["nt:/SmartDashboard/names"] == ["a", "b"]
        assert page.types["nt:/SmartDashboard/kP"] == "double"
        page.until(lambda: page.station["text"] == "Teleoperated disabled")
        for number in range(300):
            robot.set("/SmartDashboard/kP", "double", float(number))
        page.until(lambda: page.values["nt:/SmartDashboard/kP"] == 299.0)
        assert curve(page, "nt:/SmartDashboard/kP") == [0.5, *map(float, range(300))], "every change is kept"
        assert page.hello["source"]["kind"] == "robot"
        for word, text in ((AUTONOMOUS, "Autonomous enabled"), (TELEOP, "Teleoperated enabled")):
            robot.set(WORD, "int", word)
            page.until(lambda text=text: page.station["text"] == text)
        robot.set("/SmartDashboard/Match Time", "double", 73.4)
        page.until(lambda: page.station.get("match_left") == 73.4)
        robot.remove("/SmartDashboard/names")
        page.until(lambda: "nt:/SmartDashboard/names" not in page.values)
        for name in ("enable", "disable", "e_stop", "rewind", "restart", "axis", "button"):
            assert page.ask(type="command", name=name)["type"] == "error"


def test_a_link_that_is_cut_and_back(robot: NetworkRobot, tmp_path: Path) -> None:
    robot.set("/x", "double", 1.0)
    with link_to(robot.port) as link, shown(tmp_path, link.port) as there, there.page() as page:
        page.until(lambda: page.values.get("nt:/x") == 1.0)
        robot.set(WORD, "int", TELEOP)
        page.until(lambda: page.station["text"] == "Teleoperated enabled")
        link.cut()
        page.until(lambda: page.station["text"] == "No connection")
        assert page.values["nt:/x"] == 1.0
        robot.set("/x", "double", 2.0)
        link.mend()
        page.until(lambda: page.values["nt:/x"] == 2.0)
        robot.set("/x", "double", 3.0)
        page.until(lambda: page.values["nt:/x"] == 3.0)
        assert curve(page, "nt:/x") == [1.0, 2.0, 3.0]
        assert curve(page, "sim.mode") == ["disabled", "teleop", "no connection", "teleop"]
        said = [line["text"] for line in page.console if line["level"] == "pyfrc"]
        assert sum("was lost" in text for text in said) == 1
        assert sum(text.startswith("Connected") for text in said) == 2
        assert not page.parts["branches"]


def test_a_program_that_started_again_is_another_run(robot: NetworkRobot, tmp_path: Path) -> None:
    robot.set("/x", "double", 1.0)
    robot.set("/old", "boolean", True)
    with shown(tmp_path, robot.port) as there, there.page() as page:
        page.until(lambda: page.values.get("nt:/x") == 1.0)
        robot.set("/x", "double", 2.0)
        page.until(lambda: page.values["nt:/x"] == 2.0)
        robot.restart()
        robot.set("/x", "double", 5.0)
        page.until(lambda: page.parts["run"]["number"] == 2 and page.values.get("nt:/x") == 5.0)
        assert "nt:/old" not in page.values
        page.until(lambda: page.parts["branches"])
        (before,) = page.parts["branches"]
        assert before["name"] == "before the restart"
        asked = {"from": 0, "to": 1000, "points": 100, "branch": before["id"]}
        assert page.ask(type="plot", paths=["nt:/x"], **asked)["series"]["nt:/x"]["v"] == [1.0, 2.0]
        page.until(lambda: any("starts again" in line["text"] for line in page.console))


def test_values_are_set_only_after_the_switch(robot: NetworkRobot, tmp_path: Path) -> None:
    robot.set("/SmartDashboard/kP", "double", 0.5)
    robot.set("/SmartDashboard/Auto/.type", "string", "String Chooser")
    robot.set("/SmartDashboard/Auto/options", "string[]", ["Left", "Right"])
    robot.set("/SmartDashboard/Auto/active", "string", "Left")

    def ask(page: Page, name: str, **arguments: Any) -> str:
        return str(page.ask(type="command", name=name, **arguments).get("message", ""))

    with shown(tmp_path, robot.port) as there, there.page() as page, there.page() as other:
        page.until(lambda: page.parts.get("choosers"))
        assert page.parts["choosers"][0]["options"] == ["Left", "Right"]
        kP = {"nt:/SmartDashboard/kP": 0.25}
        assert "Tuning is off" in ask(page, "write", values=kP)
        assert robot.get("/SmartDashboard/kP") == 0.5
        page.command("tune", on=True)
        assert "Tuning is off" in ask(other, "write", values=kP)  # each page has a switch of its own
        page.command("write", values=kP)
        page.until(lambda: page.values["nt:/SmartDashboard/kP"] == 0.25)
        other.until(lambda: other.values["nt:/SmartDashboard/kP"] == 0.25)
        robot.until("/SmartDashboard/kP", 0.25)
        page.command("choose", chooser="/SmartDashboard/Auto", option="Right")
        robot.until(f"/SmartDashboard/Auto/{CURRENT.dashboards.choice}", "Right")
        for target, value, why in (
            ("nt:/SmartDashboard/kP", "much", "a number is needed"),
            ("nt:/SmartDashboard/kI", 1.0, "publishes no value"),
            ("dio[3].value", True, "publishes no value"),
            (f"nt:{WORD}", TELEOP, "cannot be set"),
            ("nt:/SmartDashboard/Auto/.type", "x", "cannot be set"),
        ):
            assert why in ask(page, "write", values={target: value})
        page.command("tune", on=False)
        assert "Tuning is off" in ask(page, "write", values=kP)
        assert robot.get(WORD) == DISABLED
        assert "Tuning is off" not in ask(page, "tune", on=True)
    with shown(tmp_path, robot.port) as there, there.page(there.viewing_address) as guest:
        assert "only shows" in ask(guest, "tune", on=True)


def test_the_page_of_a_camera_may_load_its_addresses_and_nothing_else(robot: NetworkRobot, tmp_path: Path) -> None:
    given = [
        "mjpg:http://roborio-1234-frc.local:1181/?action=stream",
        "mjpg:http://10.12.34.2:1181/stream.mjpg?name=a;b",
        "mjpg:javascript:alert(1)",
        "mjpg:http://evil.example/a b",
        "mjpg:http://x';script-src:1/",
        "rtsp://10.12.34.2/",
    ]
    robot.set("/CameraPublisher/<Front>/streams", "string[]", given)
    with shown(tmp_path, robot.port) as there, there.page() as page:
        page.until(lambda: "nt:/CameraPublisher/<Front>/streams" in page.values)
        query = urlsplit(there.viewing_address).query
        status, headers, content = there.get(f"/camera?{query}&name=%3CFront%3E")
        assert status == 200
        policy = dict(rule.split(" ", 1) for rule in headers["content-security-policy"].split("; "))
        assert policy["img-src"] == "http://10.12.34.2:1181/stream.mjpg http://roborio-1234-frc.local:1181/"
        assert (policy["default-src"], policy["frame-ancestors"]) == ("'none'", "'self'")
        assert headers["x-frame-options"] == "SAMEORIGIN"
        assert b"&lt;Front&gt;" in content
        assert b"<Front>" not in content
        assert b"evil" not in content
        _, headers, content = there.get(f"/camera?{query}&name=none")
        assert b"has published no address" in content
        assert "img-src 'none'" in headers["content-security-policy"]
        assert there.get("/camera?token=x&name=none")[0] == 403
        _, headers, _ = there.get(f"/?{query}")
        assert "img-src 'self' data: blob:;" in headers["content-security-policy"]
        assert headers["x-frame-options"] == "DENY"


@pytest.mark.slow
def test_a_flood_of_changes_leaves_the_page_alive(robot: NetworkRobot, tmp_path: Path) -> None:
    with shown(tmp_path, robot.port) as there, there.page() as page:
        page.until(lambda: page.station["text"] == "Teleoperated disabled")
        page.ask(type="show", paths=["nt:/flood/0"], beginnings=[])
        changes: list[int] = []
        flooding = threading.Thread(target=lambda: changes.append(robot.flood(250, 5000, 20.0)))
        flooding.start()
        page.until(lambda: not flooding.is_alive())  # an update comes ten times a second
        last = float((changes[0] - 1) // 250 * 250)
        page.until(lambda: page.values["nt:/flood/0"] == last)
        assert changes[0] > 90_000
        assert sum(len(curve(page, f"nt:/flood/{number}")) for number in range(250)) == changes[0]


def test_values_that_come_late_are_said_to_be_late(tmp_path: Path) -> None:
    class Flooded:
        """A client with what was published in the first second, ten seconds later."""

        now_us = 10_000_000

        def read(self) -> list[Any]:
            return [Received(f"/{number}", "double", 1.0, 1_000_000) for number in range(2000)]

    printed: list[str] = []
    where = addresses_for("10.12.34.2", None)
    found = LiveRobot(Project(tmp_path / "robot.py"), where, lambda host: None, printed.append)
    found._connected(Connected("10.12.34.2", 5810))
    found._runs.connect(-10.0, 1)
    client: Any = Flooded()
    for _ in range(3):
        found._look(client)
    assert "seconds late" in found.status.note
    assert sum("seconds late" in text for text in printed) == 1
    found._connected(Connected("10.12.34.2", 5810))
    assert not found.status.note


#: A robot at an address that only this computer's Driver Station knows, and what finds it by its team's number.
_KNOWN_TO_DRIVER_STATION = """
import json, pathlib, socket, subprocess, threading
from pyfrc_core.project import Project
from pyfrc_core.sim.live.addresses import addresses_for
from pyfrc_core.sim.live.robot import LiveRobot
from pyfrc_core.wpi import network

robot = "10.12.34.77"
subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
subprocess.run(["ip", "address", "add", robot + "/24", "dev", "lo"], check=True)
server = network.NetworkServer(robot, 5810)
said = {"robotIP": int.from_bytes(socket.inet_aton(robot), "big"), "robotIp": robot}  # until 2026, and from 2027 on

def serve(listener):
    connected = listener.accept()[0]
    connected.sendall(json.dumps(said).encode() + b"\\n")
    connected.recv(1)

for port in (1742, 6770):
    threading.Thread(target=serve, args=(socket.create_server(("127.0.0.1", port)),), daemon=True).start()
found = LiveRobot(Project(pathlib.Path("robot.py").resolve()), addresses_for("1234", None), lambda host: None)
found.start()
with found.reports:
    found.reports.wait_for(lambda: found.status.network_address, 60)
print(found.status.network_address)
found.close()
"""


def test_a_robot_is_found_at_the_address_that_the_driver_station_knows(tmp_path: Path) -> None:
    require_roborio()  # for its namespaces: the port of the Driver Station is one for the whole computer
    require("asking the Driver Station for the robot's address", missing_programs("ip"))
    done = subprocess.run(
        ["unshare", "-n", sys.executable, "-c", _KNOWN_TO_DRIVER_STATION],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == "10.12.34.77:5810\n", done.stderr


def test_a_server_that_was_closed_takes_nothing_from_the_next_one(tmp_path: Path) -> None:
    """The library gives the numbers of what was destroyed to what is made next."""
    port = lasting_port()
    for _ in range(2):
        before = network.NetworkServer("127.0.0.1", port)
        before.close()
        server = network.NetworkServer("127.0.0.1", port)
        del before
        gc.collect()
        client = network_client.Client("a dashboard", [("127.0.0.1", port)])
        client.write("/x", 0.5, "double")
        end = monotonic() + PATIENCE
        while ("/x", 0.5) not in [(update.name, update.value) for update in server.written.read()]:
            assert monotonic() < end
        client.close()
        server.close()
