"""Let robot programs run side by side although their libraries use fixed UDP ports.

On a robot, one program runs, and a library may rely on its port: photonlibpy's time server has 5810. Here, tests,
matches of a campaign and simulators run at the same time, and `bind` would fail in all of them but one. A socket whose
port *another process* uses gets a free one instead. A port that is bound twice in one process is an error, as on a
robot. So is a stream's port: its clients would connect to the other process.

A network namespace for each process would keep the ports, but needs privileges, and Linux.
"""

from __future__ import annotations

import errno
import socket
import weakref
from typing import Any

from ...patch_table import Patch

# By family and requested port. A `WeakSet` could change while a second thread goes through it.
_bound: dict[tuple[int, int], weakref.ref[socket.socket]] = {}


def patches() -> list[Patch]:
    """Return the replacement of `socket.socket.bind`."""
    real = socket.socket.bind

    def bind(sock: socket.socket, address: Any, /) -> None:
        __tracebackhide__ = True
        port = _udp_port(sock, address)
        if port is None:
            real(sock, address)
            return
        place = (sock.family, port)
        try:
            real(sock, address)
        except OSError as error:
            if error.errno != errno.EADDRINUSE or _is_used_here(place):
                raise
            real(sock, (address[0], 0, *address[2:]))
        _bound[place] = weakref.ref(sock)

    return [Patch(socket.socket, "bind", bind)]


def _udp_port(sock: socket.socket, address: object) -> int | None:
    """Return the fixed UDP port of the address, if it has one."""
    if sock.type != socket.SOCK_DGRAM or sock.family not in (socket.AF_INET, socket.AF_INET6):
        return None
    if not isinstance(address, tuple) or len(address) < 2 or not isinstance(address[1], int):
        return None
    return address[1] or None


def _is_used_here(place: tuple[int, int]) -> bool:
    """Return whether a socket of this process has asked for the port and is still open."""
    sock = _bound.get(place, lambda: None)()
    return sock is not None and sock.fileno() != -1
