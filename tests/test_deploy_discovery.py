"""Finding the robot among addresses with and without servers."""

from __future__ import annotations

import json
import socket
import struct
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from dataclasses import replace

import pytest
from loops import for_each
from ports import refusing_port
from roborio import PATIENCE

from pyfrc_core.deploy import discovery
from pyfrc_core.deploy.discovery import Address, RobotNotFoundError, addresses_of, find_robot, parse_address
from pyfrc_core.deploy.errors import OnTheFieldError
from pyfrc_core.deploy.targets import CONTROLLERS, ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.errors import UsageError

BANNER = b"SSH-2.0-look-alike\r\n"


class Servers:
    """Servers on this computer, which send fixed data to each client."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        #: Whether the client has gone, by the address.
        self.ends: dict[Address, threading.Event] = {}

    def start(self, says: bytes, host: str = "127.0.0.1", after: float = 0.0) -> Address:
        listener = self._stack.enter_context(socket.create_server((host, 0)))
        address = Address(host, listener.getsockname()[1])
        ended = self.ends[address] = threading.Event()

        def serve() -> None:
            try:
                connected, _ = listener.accept()
            except OSError:
                return
            with connected:
                with suppress(ConnectionError):  # closed with our greeting unread
                    time.sleep(after)
                    connected.sendall(says)
                    if says.startswith(b"SSH-"):
                        connected.recv(1)
                ended.set()

        threading.Thread(target=serve, daemon=True).start()
        return address

    def nobody(self) -> Address:
        """An address that refuses."""
        return Address("127.0.0.1", self._stack.enter_context(refusing_port()))


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """The limits are not what is tested, and these servers may be held up together with the search."""
    for name in ("CONNECT_SECONDS", "RESOLVE_SECONDS", "DRIVER_STATION_SECONDS"):
        monkeypatch.setattr(discovery, name, PATIENCE)


@pytest.fixture
def servers() -> Iterator[Servers]:
    with ExitStack() as stack:
        yield Servers(stack)


Station = tuple[ControllerKind, int]
#: Each Driver Station of each controller: 2027's robots can be driven by two.
STATIONS = [(each, number) for each in CONTROLLERS for number in range(len(each.stations))]


@pytest.fixture(params=STATIONS, ids=lambda station: f"{station[0].name} {station[0].stations[station[1]].port}")
def kind(request: pytest.FixtureRequest) -> Station:
    return request.param


def find(
    servers: Servers,
    *candidates: Address,
    station: Address | None = None,
    kind: Station = (ROBORIO, 0),
    **how: bool,
) -> discovery.FoundRobot:
    controller, number = kind
    stations = [replace(each, port=servers.nobody().port) for each in controller.stations]
    if station is not None:
        stations[number] = replace(stations[number], port=station.port)
    controller = replace(controller, stations=tuple(stations))
    return find_robot([(each, "a place") for each in candidates], "team 1234", controller, **how)


def station_says(servers: Servers, kind: Station, robot: str | None = None, on_field: bool = False) -> Address:
    said: dict[str, object] = {"robotIp": robot, "fmsControlled": on_field}
    if kind[0].stations[kind[1]].port == 1742:
        said = {"robotIP": struct.unpack("!I", socket.inet_aton(robot or "0.0.0.0"))[0], "FMS Connected": on_field}
    return servers.start(json.dumps(said).encode() + b"\n")


def test_the_address_with_an_ssh_server_wins(servers: Servers) -> None:
    robot = servers.start(BANNER)
    found = find(servers, servers.nobody(), servers.start(b"220 mail\r\n"), robot, servers.start(b""))
    with found.connected:
        assert found.address == robot
        assert found.connected.recv(100) == BANNER  # still there to be read


def test_the_others_are_closed(servers: Servers) -> None:
    robots = [servers.start(BANNER) for _ in range(5)]
    found = find(servers, *robots)
    for robot in robots:
        if robot != found.address:
            # Those that were connected see the end; the winner has not seen it. One that was not yet, is now.
            socket.create_connection((robot.host, robot.port)).close()
            assert servers.ends[robot].wait(PATIENCE)
    assert not servers.ends[found.address].is_set()
    found.connected.close()


def test_failed_attempts_are_shown_as_a_table(servers: Servers) -> None:
    nobody, mail, mute = servers.nobody(), servers.start(b"220 mail\r\n"), servers.start(b"")
    nowhere = Address("no-such-robot.invalid")
    with pytest.raises(RobotNotFoundError) as caught:
        find(servers, nobody, nowhere, mail, mute)
    lines = str(caught.value).splitlines()
    assert "team 1234" in lines[0]
    for line, address, why in zip(
        lines[1:5],
        (nobody, nowhere, mail, mute),
        ("refused", "the name is not known here", "not an SSH server", "closed the connection"),
        strict=True,
    ):
        assert line.split()[0] == str(address)
        assert why in line
    assert "--team" in lines[5]
    assert "--robot" in lines[5]
    assert lines[5].endswith("To try without a robot: pyfrc virtual-robot")
    assert [tried.address for tried in caught.value.tried] == [nobody, nowhere, mail, mute]


def test_the_driver_stations_robot_is_tried_too(
    kind: Station, servers: Servers, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def connect_elsewhere(self, address: Address, kind: str) -> None:  # port 22 of it is not ours to listen on
        asked.append((address, kind))

    monkeypatch.setattr(discovery._Race, "enter", connect_elsewhere)
    with pytest.raises(RobotNotFoundError):
        find(servers, station=station_says(servers, kind, "127.9.8.7"), kind=kind)
    assert asked == [(Address("127.9.8.7"), "the Driver Station's robot")]


@for_each("how", [{}, {"take_its_robot": False}])
def test_on_a_competition_field_it_is_refused(how: dict[str, bool], kind: Station, servers: Servers) -> None:
    robot = servers.start(BANNER)
    with pytest.raises(OnTheFieldError, match=r"FMS.*\n.*when your match is over"):
        find(servers, robot, station=station_says(servers, kind, on_field=True), kind=kind, **how)
    assert servers.ends[robot].wait(PATIENCE)


def test_a_driver_station_on_a_busy_computer_is_waited_for(servers: Servers, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only connecting to it has a short limit: most computers have none, and some only notice that late."""
    monkeypatch.setattr(discovery, "DRIVER_STATION_SECONDS", 0.2)
    station = servers.start(b'{"robotIP": 0, "FMS Connected": true}\n', after=0.6)
    with pytest.raises(OnTheFieldError):
        find(servers, servers.start(BANNER), station=station)


@for_each("says", [b"", b"nonsense\n", b"[]\n", b'{"robotIP": "x", "FMS Connected": 1}\n', b"\xff\n"])
def test_useless_data_of_a_driver_station_is_ignored(says: bytes, servers: Servers) -> None:
    robot = servers.start(BANNER)
    found = find(servers, robot, station=servers.start(says))
    found.connected.close()
    assert found.address == robot


@for_each(
    "team, first",
    [(1, "10.0.1.2"), (254, "10.2.54.2"), (1234, "10.12.34.2"), (10000, "10.100.0.2"), (25599, "10.255.99.2")],
)
def test_a_teams_addresses(team: int, first: str) -> None:
    every = [str(address) for address, _ in addresses_of(team, ROBORIO)]
    name = f"roboRIO-{team}-FRC"
    assert every == [first, f"{name}.local", "172.22.11.2", name, f"{name}.lan", f"{name}.frc-field.local"]
    assert [str(address) for address, _ in addresses_of(team, ROBORIO, resolve=False)] == [first, "172.22.11.2"]


@for_each(
    "text, address",
    [
        ("10.0.0.2", Address("10.0.0.2")),
        ("robot.local:2222", Address("robot.local", 2222)),
        ("fe80::1", Address("fe80::1")),
        ("[fe80::1]:2222", Address("fe80::1", 2222)),
        ("[::1]", Address("::1")),
        ("::ffff:10.12.34.2", Address("10.12.34.2")),
        ("[::ffff:10.12.34.2]:22", Address("10.12.34.2")),
        ("[::FFFF:0a0c:2202]:2222", Address("10.12.34.2", 2222)),
        ("FE80:0:0::0001%eth0", Address("fe80::1%eth0")),
        ("10.12.34.2.", Address("10.12.34.2")),
        ("roboRIO-1234-FRC.local.", Address("roboRIO-1234-FRC.local")),
        ("10.12.34.2:022", Address("10.12.34.2")),
    ],
)
def test_an_address_has_one_form(text: str, address: Address) -> None:
    """Keys are pinned for addresses: another spelling must not be another address."""
    assert parse_address(text) == address
    assert parse_address(str(address)) == address


@for_each(
    "text",
    [
        *("10.12.34.02", "010.12.34.2:22", "10.12.8706", "10.795138", "168567298", "0x0a0c2202", "0XA.12.34.2"),
        *("10.12.34.300", "0x", "9" * 30, "1234"),
    ],
)
def test_an_old_spelling_of_an_address_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="not a valid address") as caught:
        parse_address(text)
    assert ("--team 1234" if text == "1234" else "as in 10.12.34.2") in str(caught.value)


@for_each(
    "text",
    [
        *("\uff11\uff10.12.34.2", "10\u300212\u300234\u30022", "10.12.34.*", "a,b", "|1|a|b", "!robot", "a;b"),
        *("", ":22", "robot:", "robot:0", "robot:70000", "robot:ssh", "[::1]x:3"),
        *("lvuser@10.12.34.2", "http://10.12.34.2", "10.12.34.2/", "my robot", "[]"),
        *("foo..bar", ".foo", "-foo", "foo-.bar", "..", "::zz", "a%b", "a" * 64, ".".join(["a" * 60] * 5)),
    ],
)
def test_what_is_no_address_is_refused(text: str) -> None:
    if text == "robot:":
        assert parse_address(text) == Address("robot")
        return
    with pytest.raises(UsageError, match="HOST:PORT"):
        parse_address(text)
