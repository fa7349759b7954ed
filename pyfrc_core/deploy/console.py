"""Showing the robot program's output, received from the robot's console service."""

from __future__ import annotations

import contextlib
import io
import re
import socket
import struct
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from ..terminal_text import VisibleStream, visible
from .agent.console import ERROR, KEEP_ALIVE, PORTS, TEXT, split_frames
from .connection import VIRTUAL_ROBOT_GREETING
from .discovery import CONNECT_SECONDS, Address
from .errors import NoConsoleError

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


#: Kinds of messages are below this number. Kinds other than text and error are skipped.
_KINDS = 32
#: The maximum number of consecutive empty frames, which keep a connection alive. A robot sends few of them.
MAX_EMPTY_FRAMES = 1000

_TEXT_HEAD = struct.Struct(">BfH")  # kind, time in seconds, number
_ERROR_HEAD = struct.Struct(">BfHHiB")  # kind, time in seconds, number, occurrences, error code, flags
_LENGTH = struct.Struct(">H")


class ConsoleProtocolError(ValueError):
    """The data is not from a robot's console. The message has the reason."""


class ConsoleFrames:
    """The frames of one connection. At most one incomplete frame (64 KiB) is buffered."""

    def __init__(self) -> None:
        self._unread = b""
        self._empty = 0

    def lines(self, received: bytes) -> Iterator[str]:
        """Yield the line of each complete frame, without a newline.

        :param received: the next bytes
        :raises ConsoleProtocolError: if the data is not from a robot's console
        """
        frames, self._unread = split_frames(self._unread + received)
        for frame in frames:
            if frame:
                self._empty = 0
                line = _line(frame)
                if line is not None:
                    yield line
            else:
                self._empty += 1
                if self._empty > MAX_EMPTY_FRAMES:
                    raise ConsoleProtocolError("it sends too many empty frames")
        if len(self._unread) > 2:
            _check_kind(self._unread[2])  # checked early, since the rest of the frame may never arrive

    def reset_count(self) -> None:
        """Reset the count of empty frames, after some time has passed."""
        self._empty = 0


def _check_kind(kind: int) -> None:
    if kind >= _KINDS:
        raise ConsoleProtocolError(f"it sends messages of kind {kind}, which does not exist")


def _line(frame: bytes) -> str | None:
    kind = frame[0]
    _check_kind(kind)
    if kind == TEXT:
        if len(frame) < _TEXT_HEAD.size:
            raise ConsoleProtocolError(f"it sends a text message of {len(frame)} bytes, which is too short")
        _, seconds, _ = _TEXT_HEAD.unpack_from(frame)
        return f"[{seconds:.2f}] {_decoded(frame[_TEXT_HEAD.size :])}"
    if kind == ERROR:
        if len(frame) < _ERROR_HEAD.size:
            raise ConsoleProtocolError(f"it sends an error message of {len(frame)} bytes, which is too short")
        _, seconds, _, _, code, _ = _ERROR_HEAD.unpack_from(frame)
        details, location, stack = _texts(frame, 3)
        return f"[{seconds:.2f}] {code} {details} {location} {stack}"
    return None


def _texts(frame: bytes, count: int) -> list[str]:
    texts, position = [], _ERROR_HEAD.size
    for _ in range(count):
        start = position + _LENGTH.size
        position = start + _LENGTH.unpack_from(frame, position)[0] if start <= len(frame) else start
        if position > len(frame):
            raise ConsoleProtocolError("it sends an error message with texts longer than the message")
        texts.append(_decoded(frame[start:position]))
    return texts


def _decoded(text: bytes) -> str:
    return text.decode(errors="replace")


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
    report = ConnectionReports(quiet)
    with contextlib.suppress(KeyboardInterrupt):
        while True:
            for line in lines_of_one_connection(address, without_driver_station, report):
                output.write(f"{line}\n")
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
            for received in _pieces(console, frames, report, is_over):
                for line in frames.lines(received):
                    yield line
                    report.reset()
        except ConsoleProtocolError as error:
            raise NoConsoleError(
                f"the server is not a robot's console: {error}",
                where=str(where),
                remedy="Check the address, or specify another with --robot HOST.",
            ) from error
        if not is_over():
            report("lost", f"the connection was lost; reconnecting to {where}")


def _pieces(
    console: socket.socket, frames: ConsoleFrames, report: ConnectionReports, is_over: Callable[[], bool]
) -> Iterator[bytes]:
    """Yield the received data until the connection is lost. Send keep-alive frames meanwhile."""
    console.settimeout(_WAKE_SECONDS)  # on Windows, Ctrl-C does not interrupt a blocking receive
    connected = kept_alive = time.monotonic()
    while not is_over():
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
