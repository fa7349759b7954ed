"""Identifies the user at the other end of a connection on this computer.

A robot accepts every user. A virtual robot runs programs as its own user, so it must reject other users of the same
computer. Only Linux provides the user of a connection; on other systems, all users of the computer are accepted.
"""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path

_TABLE = Path("/proc/net/tcp")


def is_other_user(connection: socket.socket) -> bool:
    """Return whether the other end of a loopback connection belongs to another user; False if unknown."""
    if sys.platform != "linux":
        return False
    ends = [_as_in_table(*connection.getpeername()), _as_in_table(*connection.getsockname())]
    try:
        rows = [line.split() for line in _TABLE.read_text().splitlines()]
    except OSError:
        return False
    users = [int(row[7]) for row in rows if row[1:3] == ends]
    return any(user not in (os.geteuid(), 0) for user in users)


def _as_in_table(host: str, port: int) -> str:
    return f"{int.from_bytes(socket.inet_aton(host), sys.byteorder):08X}:{port:04X}"
