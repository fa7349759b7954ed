"""Showing the robot program's output, received from the robot's console service."""

from __future__ import annotations

import contextlib
import io
import re
import socket
import sys
import time
from collections.abc import Iterator

from ..terminal_text import VisibleStream, visible
from .agent.console import KEEP_ALIVE, PORTS
from .connection import VIRTUAL_ROBOT_GREETING
from .console_frames import ConsoleFrames, ConsoleProtocolError
from .discovery import CONNECT_SECONDS, Address
from .errors import NoConsoleError
from .imitated_driver_station import TCP_PORT, imitated_driver_station

_SECONDS_BETWEEN_TRIES = 1.0
_KEEP_ALIVE_SECONDS = 2.0
_WAKE_SECONDS = 0.5
#: A connection that lasts this long counts as stable even without output. Its loss is reported again.
_STABLE_SECONDS = 5.0
_RECEIVE_BYTES = 1 << 16


def console_port(address: Address) -> int | None:
    """Return the console port in the SSH greeting of a virtual robot, or None for other robots.

    :raises OSError: if the server cannot be reached
    """
    with socket.create_connection((address.host, address.port), timeout=CONNECT_SECONDS) as server:
        server.settimeout(CONNECT_SECONDS)
        with server.makefile("rb") as greeting:
            named = re.match(
                rb"%s console=([0-9]{1,5})\r\n" % re.escape(VIRTUAL_ROBOT_GREETING.encode()), greeting.readline(256)
            )
    return int(named[1]) if named and int(named[1]) < 65536 else None


def follow_console(address: Address, without_driver_station: bool = False, quiet: bool = False) -> None:
    """Show the robot program's output until Ctrl-C. Reconnect after a lost connection.

    :param without_driver_station: imitate a Driver Station, so that the robot sends its output without one
    :param quiet: do not report the state of the connection
    :raises NoConsoleError: if the server is not a robot's console
    """
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)  # flush each line, also to a pipe
    output = VisibleStream(sys.stdout)
    report = _Reports(quiet)
    with contextlib.suppress(KeyboardInterrupt):
        while True:
            for line in _lines_of_one_connection(address, without_driver_station, report):
                output.write(f"{line}\n")
            time.sleep(_SECONDS_BETWEEN_TRIES)


class _Reports:
    """Reports about the connection on standard error. Each is printed once until `reset`."""

    def __init__(self, quiet: bool) -> None:
        self._quiet = quiet
        self._made: set[str] = set()

    def __call__(self, kind: str, text: str) -> None:
        if not self._quiet and kind not in self._made:
            print(visible(text), file=sys.stderr, flush=True)
        self._made.add(kind)

    def reset(self) -> None:
        """Allow each report to be printed again."""
        self._made.clear()


def _lines_of_one_connection(address: Address, without_driver_station: bool, report: _Reports) -> Iterator[str]:
    """Yield the lines of one connection until it is lost."""
    where = address
    with contextlib.ExitStack() as open_now:
        try:
            port = None if address.port == 22 else console_port(address)
            if port is None and without_driver_station:
                where = Address(address.host, TCP_PORT)
                open_now.enter_context(imitated_driver_station(address.host))
            where = Address(address.host, port or PORTS[0])
            console = open_now.enter_context(
                socket.create_connection((where.host, where.port), timeout=CONNECT_SECONDS)
            )
            console.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except ConnectionRefusedError:
            report("refused", f"{where} refuses the connection: check the address, and that the robot is on")
            return
        except OSError as error:
            why = error.strerror or error
            report(
                "unreachable",
                f"{where} cannot be reached ({why}): check that the robot is on, and this computer connected to it",
            )
            return
        report("connected", f"connected to {where}")
        frames = ConsoleFrames()
        try:
            for received in _pieces(console, frames, report):
                for line in frames.lines(received):
                    yield line
                    report.reset()
        except ConsoleProtocolError as error:
            raise NoConsoleError(
                f"the server is not a robot's console: {error}",
                where=str(where),
                remedy="Check the address, or specify another with --robot HOST.",
            ) from error
        report("lost", f"the connection was lost; reconnecting to {where}")


def _pieces(console: socket.socket, frames: ConsoleFrames, report: _Reports) -> Iterator[bytes]:
    """Yield the received data until the connection is lost. Send keep-alive frames meanwhile."""
    console.settimeout(_WAKE_SECONDS)  # on Windows, Ctrl-C does not interrupt a blocking receive
    connected = kept_alive = time.monotonic()
    while True:
        received = None
        try:
            with contextlib.suppress(TimeoutError):
                received = console.recv(_RECEIVE_BYTES)
            now = time.monotonic()
            if now - kept_alive >= _KEEP_ALIVE_SECONDS:
                kept_alive = now
                frames.reset_count()
                console.sendall(KEEP_ALIVE)
        except OSError:
            return
        if received == b"":
            return
        if now - connected >= _STABLE_SECONDS:
            report.reset()
        if received is not None:
            yield received
