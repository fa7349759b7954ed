"""Finding the robot: all addresses are tried in parallel, and the first one with an SSH server wins."""

from __future__ import annotations

import ipaddress
import json
import queue
import re
import socket
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from ..errors import UsageError
from .errors import DeployError, OnTheFieldError
from .targets import MAX_TEAM, ControllerKind, DriverStation

#: Time limit for each address, in seconds: enough for a radio that loses packets.
CONNECT_SECONDS = 5.0
#: Time limit for resolving names, in seconds.
RESOLVE_SECONDS = 5.0
#: Time limit for connecting to the Driver Station, in seconds. Windows takes long to refuse a connection.
DRIVER_STATION_SECONDS = 1.0

_BANNER = b"SSH-"
_LABEL = r"(?!-)[A-Za-z0-9_-]{1,63}(?<!-)"
#: A name that a computer can have; `parse_address` has removed a dot at its end.
_HOST_NAME = re.compile(rf"{_LABEL}(?:\.{_LABEL})*")
_MOST_LETTERS = 253


@dataclass(frozen=True)
class Address:
    """A possible address of an SSH server."""

    host: str
    port: int = 22

    def __str__(self) -> str:
        if self.port == 22:
            return self.host
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"

    @property
    def is_name(self) -> bool:
        """Return whether it is a host name, which must be resolved."""
        for family in (socket.AF_INET, socket.AF_INET6):
            try:
                socket.inet_pton(family, self.host.partition("%")[0])
            except OSError:
                continue
            return False
        return True


@dataclass(frozen=True)
class FailedAttempt:
    """An address that was tried, its kind, and the reason for the failure."""

    address: Address
    kind: str
    why: str


class RobotNotFoundError(DeployError):
    """No robot responded at any address.

    :ivar tried: the failed attempts with their reasons
    """

    tried: tuple[FailedAttempt, ...] = ()


@dataclass(frozen=True)
class FoundRobot:
    """The robot that was found.

    :param address: the address that was tried; a host name is not replaced by its address
    :param kind: a description of the address
    :param connected: a socket connected to the robot, from which nothing was read
    """

    address: Address
    kind: str
    connected: socket.socket


def parse_address(text: str) -> Address:
    """Parse ``HOST``, ``HOST:PORT`` or ``[IPV6]:PORT``. A numeric address is normalized.

    :raises UsageError: if the text is not an address, or is a number that systems interpret differently
    """
    host, port = text.strip(), ""
    if host.startswith("["):
        host, _, port = host[1:].partition("]")
        port = port.removeprefix(":")
    elif host.count(":") == 1:
        host, _, port = host.partition(":")
    # No other characters: name resolution treats some of them as digits or dots.
    if not re.fullmatch(r"[A-Za-z0-9_.:%-]+", host) or (port and not (port.isdecimal() and 1 <= int(port) <= 65535)):
        raise _no_address(text)
    normal = _normal(host.removesuffix("."))
    address = Address(normal, int(port or 22))
    if address.is_name and (len(normal) > _MOST_LETTERS or not _HOST_NAME.fullmatch(normal)):
        raise _no_address(text)
    return address


def _no_address(text: str) -> UsageError:
    return UsageError(f"{text!r} is not an address of a robot", remedy="Write HOST or HOST:PORT, as in 10.12.34.2")


def _normal(host: str) -> str:
    """Return the normalized host. Keys are pinned for it, so all spellings of an address must give the same host."""
    try:
        number = ipaddress.ip_address(host)
    except ValueError:
        if re.fullmatch(r"(0x[0-9a-f]*|[0-9]+)(\.(0x[0-9a-f]*|[0-9]+))*", host, re.IGNORECASE):
            raise UsageError(f"{host!r} is not a valid address", remedy=_right_spelling(host)) from None
        return host
    return str(getattr(number, "ipv4_mapped", None) or number)


def _right_spelling(host: str) -> str:
    if host.isdecimal() and len(host) <= 5 and 1 <= int(host) <= MAX_TEAM:
        return f"For a team's robot, write --team {int(host)}; for an address, four numbers, as in 10.12.34.2"
    return "Write four numbers from 0 to 255, without zeros before them, as in 10.12.34.2"


def addresses_of(team: int, controller: ControllerKind, resolve: bool = True) -> list[tuple[Address, str]]:
    """Return the possible addresses of a team's robot, each with a description.

    :param resolve: include host names
    """
    every = [(Address(host), kind) for host, kind in controller.addresses(team)]
    return [(address, kind) for address, kind in every if resolve or not address.is_name]


def find_robot(
    candidates: Sequence[tuple[Address, str]],
    whose: str,
    controller: ControllerKind,
    *,
    take_its_robot: bool = True,
) -> FoundRobot:
    """Connect to the first robot that responds.

    :param candidates: addresses, each with a description
    :param whose: the robot in the error message, such as ``team 1234``
    :param take_its_robot: also try the robot that the Driver Station is connected to
    :raises OnTheFieldError: if the Driver Station is connected to a competition field
    :raises RobotNotFoundError: with a table of all failed attempts
    """
    race = _Race()
    for address, kind in candidates:
        race.enter(address, kind)
    for station in controller.stations:
        race.ask_driver_station(station, take_its_robot)
    found = race.winner()
    if race.on_field:
        if found is not None:
            found.connected.close()
        raise OnTheFieldError(
            "the Driver Station is connected to a competition field (FMS): robots must not be changed there",
            remedy="Deploy when your match is over and the robot is back in your pit.",
        )
    if found is None:
        raise not_found(whose, race.reasons())
    return found


def not_found(whose: str, tried: Sequence[FailedAttempt]) -> RobotNotFoundError:
    """The error, with what was tried as a table."""
    widths = [max((len(text) for text in column), default=0) for column in zip(*map(_row, tried), strict=True)]
    table = "".join(
        "\n  " + "  ".join(text.ljust(width) for text, width in zip(_row(each), widths, strict=True)).rstrip()
        for each in tried
    )
    named = len(tried) == 1 and str(tried[0].address) == whose
    which = "address?" if named else "team? (--team NUMBER; or name the robot's address with --robot HOST)"
    remedy = f"Is the robot on, and this computer on its network or at its USB cable? Is that the right {which}"
    if named and _is_this_computer(tried[0].address.host):
        remedy = (
            "Is that the right address, with its port? A virtual robot prints it. Start one in another terminal: "
            "pyfrc virtual-robot"
        )
    else:
        remedy += " To try without a robot: pyfrc virtual-robot"
    error = RobotNotFoundError(f"no robot found for {whose}; tried:{table}", remedy=remedy)
    error.tried = tuple(tried)
    return error


def _is_this_computer(host: str) -> bool:
    return host in ("localhost", "::1") or re.fullmatch(r"127(?:\.[0-9]{1,3}){3}", host) is not None


def _row(tried: FailedAttempt) -> tuple[str, str, str]:
    return str(tried.address), tried.kind, tried.why


@dataclass(frozen=True)
class _StationSaid:
    """The robot that a Driver Station is connected to, and whether that is on a competition field."""

    robot: str | None
    on_field: bool


@dataclass
class _Race:
    """All the attempts, each on a thread of its own; this one looks at what comes of them."""

    tried: list[FailedAttempt] = field(default_factory=list)
    on_field: bool = False
    _results: queue.Queue[Any] = field(default_factory=queue.Queue)
    _running: int = 0
    _over: threading.Event = field(default_factory=threading.Event)
    #: The addresses with their descriptions, in the order of the candidates.
    _entered: dict[Address, str] = field(default_factory=dict)
    _stations_asked: int = 0

    def enter(self, address: Address, kind: str) -> None:
        if address in self._entered:
            return
        self._entered[address] = kind
        self._start(self._resolve, address, kind)

    def ask_driver_station(self, station: DriverStation, take_its_robot: bool) -> None:
        self._stations_asked += 1
        self._start(self._driver_station, station, take_its_robot)

    def winner(self) -> FoundRobot | None:
        found: FoundRobot | None = None
        end = time.monotonic() + RESOLVE_SECONDS + CONNECT_SECONDS
        # The results of the Driver Stations are needed even if a robot responds first.
        while self._running and (found is None or self._stations_asked):
            try:
                result = self._results.get(timeout=max(end - time.monotonic(), 0))
            except queue.Empty:
                break
            self._running -= 1
            if isinstance(result, FoundRobot) and found is None:
                found = result
            elif isinstance(result, FoundRobot):
                result.connected.close()
            elif isinstance(result, FailedAttempt):
                self.tried.append(result)
            elif isinstance(result, _StationSaid):
                self._stations_asked -= 1
                self.on_field = self.on_field or result.on_field
                if result.robot is not None:
                    self.enter(Address(result.robot), "the Driver Station's robot")
            else:
                for next_step in result:
                    next_step()
        self._over.set()
        self._close_late_ones()
        return found

    def reasons(self) -> list[FailedAttempt]:
        """Return the failed attempts in the order of the candidates."""
        failed = {tried.address for tried in self.tried}
        late = f"no response within {RESOLVE_SECONDS + CONNECT_SECONDS:g} s"
        silent = [
            FailedAttempt(address, kind, late) for address, kind in self._entered.items() if address not in failed
        ]
        order = list(self._entered)
        return sorted([*self.tried, *silent], key=lambda tried: order.index(tried.address))

    def _start(self, function: Any, *arguments: Any) -> None:
        self._running += 1
        threading.Thread(target=lambda: self._finish(function(*arguments)), daemon=True).start()

    def _finish(self, result: object) -> None:
        self._results.put(result)
        if self._over.is_set():  # looked at after the result is there: one of the two threads sees both
            self._close_late_ones()

    def _close_late_ones(self) -> None:
        """Close the connections that came after the winner, or after the time limit."""
        with suppress(queue.Empty):
            while True:
                if isinstance(late := self._results.get_nowait(), FoundRobot):
                    late.connected.close()

    def _resolve(self, address: Address, kind: str) -> Any:
        """Return the functions to call next, or a failed attempt."""
        try:
            infos = socket.getaddrinfo(address.host, address.port, type=socket.SOCK_STREAM)
        except (OSError, UnicodeError):
            return FailedAttempt(address, kind, "the name is not known here")
        places = dict.fromkeys((family, place) for family, _, _, _, place in infos)
        return [partial(self._start, self._connect, address, kind, family, place) for family, place in places]

    def _connect(self, address: Address, kind: str, family: int, place: Any) -> Any:
        connected = socket.socket(family, socket.SOCK_STREAM)
        try:
            connected.settimeout(CONNECT_SECONDS)
            connected.connect(place)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            banner = connected.recv(len(_BANNER), socket.MSG_PEEK)
        except OSError as error:
            connected.close()
            return FailedAttempt(address, kind, _why(error, address))
        if banner and _BANNER.startswith(banner):
            return FoundRobot(address, kind, connected)
        connected.close()
        return FailedAttempt(
            address, kind, "a server responds, but not an SSH server" if banner else "closed the connection"
        )

    def _driver_station(self, station: DriverStation, take_its_robot: bool) -> _StationSaid:
        try:
            with socket.create_connection(("127.0.0.1", station.port), timeout=DRIVER_STATION_SECONDS) as connected:
                connected.settimeout(CONNECT_SECONDS)
                with connected.makefile("rb") as lines:
                    said = json.loads(lines.readline(10_000))
            robot, on_field = station.robot(said)
        except (OSError, ValueError, AttributeError, RecursionError):
            return _StationSaid(None, False)  # usually, no Driver Station runs on this computer
        return _StationSaid(robot if take_its_robot else None, on_field)


def _why(error: OSError, address: Address) -> str:
    if isinstance(error, TimeoutError):
        return f"no response within {CONNECT_SECONDS:g} s"
    if isinstance(error, ConnectionRefusedError) and _is_this_computer(address.host):
        return f"refused: no virtual robot runs at port {address.port}"
    if isinstance(error, ConnectionRefusedError):
        return "refused: a computer is there, but no SSH server"
    if isinstance(error, ConnectionError):
        return "closed the connection"
    return (error.strerror or str(error)).lower()
