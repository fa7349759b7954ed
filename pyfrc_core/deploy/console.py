"""Showing the robot program's output: from the robot's console service, or from a command on the robot, over SSH."""

from __future__ import annotations

import re
import shlex
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress

from ..terminal_text import VisibleStream, one_line, visible
from .agent.console import PORTS, ConsoleClient, ConsoleProtocolError
from .connection import VIRTUAL_ROBOT_GREETING, Connection
from .discovery import CONNECT_SECONDS, Address
from .errors import ConnectionFailedError, NoConsoleError

#: The robot's ports for a Driver Station: its TCP connection and its control packets.
TCP_PORT, UDP_PORT = 1740, 1110
_PACKET_SECONDS = 0.02
#: Version, control (0: disabled, teleoperated, no emergency stop), request and alliance station.
_DISABLED = bytes([1, 0, 0, 0])


@contextmanager
def imitated_driver_station(host: str, tcp_port: int = TCP_PORT, udp_port: int = UDP_PORT) -> Iterator[None]:
    """Imitate a Driver Station that keeps the robot disabled, until the end of the ``with`` block.

    :raises OSError: if the robot cannot be reached
    """
    ended = threading.Event()
    with socket.create_connection((host, tcp_port), timeout=CONNECT_SECONDS) as tcp:
        tcp.setblocking(False)
        with socket.socket(tcp.family, socket.SOCK_DGRAM) as udp:
            robot = (tcp.getpeername()[0], udp_port, *tcp.getpeername()[2:])
            thread = threading.Thread(target=_send_packets, args=(tcp, udp, robot, ended), daemon=True)
            thread.start()
            try:
                yield
            finally:
                ended.set()
                thread.join()


def _send_packets(tcp: socket.socket, udp: socket.socket, robot: tuple[str | int, ...], ended: threading.Event) -> None:
    number = 0
    while not ended.is_set():
        number = (number + 1) & 0xFFFF
        with suppress(OSError):  # temporary; the console's connection shows whether the link is lost
            udp.sendto(number.to_bytes(2, "little") + _DISABLED, robot)
        with suppress(OSError):  # discard the robot's data, so that its send buffer does not fill up
            tcp.recv(1 << 16)
        ended.wait(_PACKET_SECONDS)


_SECONDS_BETWEEN_TRIES = 1.0
_WAKE_SECONDS = 0.5  # on Windows, Ctrl-C does not interrupt a blocking receive
#: A connection that lasts this long counts as stable even without output. Its loss is reported again.
_STABLE_SECONDS = 5.0
#: A longer line of a command's output is broken.
_MAX_LINE_BYTES = 1 << 16


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
    """Show the output that the robot's console service sends until Ctrl-C. Reconnect after a lost connection.

    :param without_driver_station: imitate a Driver Station, so that the robot sends its output without one
    :param quiet: do not report the state of the connection
    :raises NoConsoleError: if the server is not a robot's console
    """
    _follow(lambda report: lines_of_one_connection(address, without_driver_station, report), quiet)


def follow_output(connect: Callable[[], AbstractContextManager[Connection]], quiet: bool = False) -> None:
    """Show the output that a command on the robot prints until Ctrl-C. Reconnect after a lost connection.

    :param connect: connects to the robot, over SSH
    :param quiet: do not report the state of the connection
    :raises NoConsoleError: if the robot cannot print it
    :raises DeployError: if the robot refuses the login
    """
    _follow(lambda report: _lines_over_ssh(connect, report), quiet)


def _follow(lines: Callable[[ConnectionReports], Iterator[str]], quiet: bool) -> None:
    output, report = VisibleStream(sys.stdout), ConnectionReports(quiet)
    with suppress(KeyboardInterrupt):
        while True:
            for line in lines(report):
                output.write(f"{line}\n")
                output.flush()
            time.sleep(_SECONDS_BETWEEN_TRIES)


class ConnectionReports:
    """Reports about the connection on standard error. Each is printed once until `reset`.

    :ivar made: the kinds of those that were made since
    """

    def __init__(self, quiet: bool) -> None:
        self._quiet = quiet
        self.made: set[str] = set()

    def __call__(self, kind: str, text: str) -> None:
        if not self._quiet and kind not in self.made:
            print(visible(text), file=sys.stderr, flush=True)
        self.made.add(kind)

    def reset(self) -> None:
        """Allow each report to be printed again."""
        self.made.clear()


def lines_of_one_connection(
    address: Address,
    without_driver_station: bool,
    report: ConnectionReports,
    is_over: Callable[[], bool] = lambda: False,
) -> Iterator[str]:
    """Yield the lines of one connection until it is lost, or until it is to be over.

    :raises NoConsoleError: if the server is not a robot's console
    """
    where = address
    with ExitStack() as open_now:
        try:
            port = None if address.port == 22 else console_port(address)
            if port is None and without_driver_station:
                where = Address(address.host, TCP_PORT)
                open_now.enter_context(imitated_driver_station(address.host))
            where = Address(address.host, port or PORTS[0])
            client = ConsoleClient(where.host, [where.port])
            open_now.callback(client.disconnect)
            client.connect(CONNECT_SECONDS)
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
        connected = time.monotonic()
        try:
            while not is_over():
                for line in client.lines(_WAKE_SECONDS):
                    yield f"[{line.seconds:.2f}] {line.text}"
                    report.reset()
                if time.monotonic() - connected >= _STABLE_SECONDS:
                    report.reset()
        except ConsoleProtocolError as error:
            raise NoConsoleError(
                f"the server is not a robot's console: {error}",
                where=str(where),
                remedy="Check the address, or specify another with --robot HOST.",
            ) from error
        except OSError:
            report("lost", f"the connection was lost; reconnecting to {where}")


def _lines_over_ssh(
    connect: Callable[[], AbstractContextManager[Connection]], report: ConnectionReports
) -> Iterator[str]:
    """Yield the lines that the robot's command prints until the connection is lost."""
    try:
        with connect() as connection:
            report.reset()
            report("connected", f"connected to {connection.address}")
            yield from _printed_lines(connection)
        report("lost", f"the connection was lost; reconnecting to {connection.address}")
    except ConnectionFailedError as error:
        report("unreachable", f"{error.where}: {error.message}")


def _printed_lines(connection: Connection) -> Iterator[str]:
    """Yield what the robot's command prints.

    :raises NoConsoleError: if the command ends by itself
    """
    with connection.opened(shlex.join(connection.controller.layout.output)) as channel:
        channel.settimeout(_WAKE_SECONDS)
        unfinished = b""
        while True:
            try:
                piece = channel.recv(1 << 16)
            except TimeoutError:
                continue
            if not piece:
                break
            *lines, unfinished = (unfinished + piece).split(b"\n")
            if len(unfinished) > _MAX_LINE_BYTES:
                lines, unfinished = [*lines, unfinished], b""
            yield from (line.decode(errors="replace") for line in lines)
        if channel.exit_status_ready() and (status := channel.recv_exit_status()) > 0:
            said = channel.recv_stderr(4096).decode(errors="replace").strip()
            raise NoConsoleError(
                f"the program's output cannot be read: {one_line(said) or f'exit code {status}'}",
                where=str(connection.address),
                remedy="Perhaps the robot's image is too old.",
            )
