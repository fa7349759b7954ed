"""An imitated Driver Station, since robots send the program's output only while a Driver Station is connected."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from .discovery import CONNECT_SECONDS

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
