"""The simulator's server for browsers, and a page of it without a browser: real HTTP and WebSockets."""

from __future__ import annotations

import http.client
import json
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from time import monotonic
from typing import Any
from urllib.parse import quote, urlsplit

from sim_robots import PATIENCE
from websockets.sync.client import ClientConnection, connect

from pyfrc_core.project import find_project
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.ui.web.access import Share
from pyfrc_core.sim.ui.web.front_end import WebFrontEnd
from pyfrc_core.sim.ui.web.server import WebOptions


class Served:
    """A served simulation.

    :param printed: what was printed to the terminal
    """

    def __init__(self, simulation: Simulation, front_end: WebFrontEnd, printed: list[str]) -> None:
        self.simulation, self.front_end, self.printed = simulation, front_end, printed

    @property
    def address(self) -> str:
        """The address that drives."""
        assert self.front_end.server is not None
        return self.front_end.server.address

    @property
    def viewing_address(self) -> str:
        assert self.front_end.server is not None
        return self.front_end.server.viewing_address

    def get(self, path: str, headers: Mapping[str, str] | None = None) -> tuple[int, Mapping[str, str], bytes]:
        """Return the status, the headers and the content of a GET request."""
        host = urlsplit(self.address).netloc
        connection = http.client.HTTPConnection(host, timeout=PATIENCE)
        try:
            connection.putrequest("GET", path, skip_host=True)
            for name, value in {"Host": host, **(headers or {})}.items():
                connection.putheader(name, value)
            connection.endheaders()
            response = connection.getresponse()
            found = {name.lower(): value for name, value in response.getheaders()}
            return response.status, found, response.read()
        finally:
            connection.close()

    @contextmanager
    def page(self, address: str = "", **options: Any) -> Iterator[Page]:
        """Connect as a page does."""
        parts = urlsplit(address or self.address)
        origin = f"http://{parts.netloc}"
        given = {"origin": origin, "max_size": None, "compression": None, **options}
        with connect(f"ws://{parts.netloc}/ws?{parts.query}", **given) as socket:
            yield Page(socket)


#: The parts of messages that are replaced as a whole.
_REPLACED = ("t", "panels", "robot", "choosers", "opmodes", "branches", "drawings", "field", "run", "known_from")


class Page:
    """A page's state, brought up to date by messages, as the page's own code does it."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.hello = self._receive()
        assert self.hello["type"] == "hello", self.hello
        self.values: dict[str, Any] = {}
        self.status: dict[str, Any] = {}
        self.station: dict[str, Any] = {}
        self.console: list[dict[str, Any]] = []
        self.marks: list[dict[str, Any]] = []
        self.samples: dict[str, list[Any]] = {}
        self.trail: list[Any] = []
        self.types: dict[str, str] = {}
        self.parts: dict[str, Any] = {}
        self._number = 0
        self._take(self.hello)

    @property
    def time(self) -> float:
        """The robot time that the page shows, in seconds; 0 until the first packet."""
        return float(self.parts.get("t", 0.0))

    def _receive(self) -> dict[str, Any]:
        return json.loads(self.socket.recv(timeout=PATIENCE))  # type: ignore[no-any-return]

    def _take(self, message: dict[str, Any]) -> None:
        if "run" in message:
            self.marks, self.samples = [], {}
        self.status |= message.get("status", {})
        self.station |= message.get("station", {})
        self.values |= message.get("values", {})
        self.types |= message.get("types", {})
        for path in message.get("gone", ()):
            self.values.pop(path, None)
        self.console += message.get("console", ())
        self.marks += message.get("marks", ())
        for path, flat in message.get("samples", {}).items():
            self.samples.setdefault(path, []).extend(flat)
        if trail := message.get("trail"):
            self.trail = self.trail[: trail["from"]] + trail["points"]
        self.parts |= {key: message[key] for key in _REPLACED if key in message}

    def until(self, condition: Callable[[], object]) -> None:
        """Take updates until this is so."""
        end = monotonic() + PATIENCE
        while not condition():
            assert monotonic() < end, (self.status, self.station, self.console[-20:])
            message = self._receive()
            if message["type"] == "update":
                self._take(message)
            else:
                assert message["type"] in ("answer", "working"), message

    def ask(self, **message: Any) -> dict[str, Any]:
        """Send a message, and return its answer."""
        self._number += 1
        self.socket.send(json.dumps({**message, "id": self._number}))
        while True:
            found = self._receive()
            if found.get("id") == self._number:
                return found
            self._take(found)

    def until_type(self, kind: str) -> None:
        """Take updates until a message of this type comes."""
        while (message := self._receive())["type"] != kind:
            self._take(message)

    def command(self, name: str, **arguments: Any) -> dict[str, Any]:
        """Carry out a command, which is possible."""
        answer = self.ask(type="command", name=name, **arguments)
        assert answer["type"] == "answer", answer
        return answer

    def quit(self) -> None:
        """End the simulation, and wait until the server says so: the answer may come too late for this page."""
        self.socket.send(json.dumps({"type": "command", "name": "quit"}))
        while self._receive()["type"] != "closed":
            pass

    def run_for(self, seconds: float) -> None:
        """Let robot time pass, and wait until it has."""
        self.until(lambda: self.status["state"] == "paused")
        end = self.time + seconds - 0.001
        self.command("step", packets=round(seconds / 0.02))
        self.until(lambda: self.status["state"] in ("paused", "failed") and self.time >= end)


@contextmanager
def served(
    made: Any, share: Share | None = None, allowed_hosts: tuple[str, ...] = (), **options: Any
) -> Iterator[Served]:
    """Serve a simulation of a project."""
    given = {"speed": 0, "paused": True, "network_values": True, **options}
    simulation = Simulation(find_project(made.path), SimOptions(**given))
    with served_source(simulation, share, allowed_hosts) as found:
        assert simulation.wait_for(lambda: simulation.status.state != "starting", PATIENCE)
        yield found


@contextmanager
def served_source(source: Any, share: Share | None = None, allowed_hosts: tuple[str, ...] = ()) -> Iterator[Served]:
    """Serve any source."""
    printed: list[str] = []
    front_end = WebFrontEnd(printed.append, WebOptions(share, allowed_hosts=allowed_hosts, opens_browser=False))
    codes: list[int] = []
    thread = threading.Thread(target=lambda: codes.append(front_end.run(source)), daemon=True)
    thread.start()
    with source.reports:
        assert source.reports.wait_for(lambda: front_end.server is not None, PATIENCE)
    try:
        yield Served(source, front_end, printed)
    finally:
        front_end.close()
        thread.join(PATIENCE)
    assert codes == [0]


def send_log(server: Served, name: str, data: bytes, token: str = "") -> tuple[int, dict[str, Any]]:
    """Send a log as a page does on which it was dropped."""
    parts = urlsplit(server.address)
    connection = http.client.HTTPConnection(parts.netloc, timeout=PATIENCE)
    try:
        connection.request("POST", f"/log?{token or parts.query}&name={quote(name)}", data)
        response = connection.getresponse()
        text = response.read()
        return response.status, json.loads(text) if response.status == 200 else {}
    finally:
        connection.close()
