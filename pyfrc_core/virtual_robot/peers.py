"""Whose process is at the other end of a connection within this computer.

A robot lets everyone in; a virtual robot runs programs as its user, and so must not do that for other users of the same
computer. Only Linux says whose a connection is; elsewhere, all users of the computer are let in.
"""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path

_TABLE = Path("/proc/net/tcp")


def is_other_user(connection: socket.socket) -> bool:
    """Return whether the process at the other end of a loopback connection is known to be another user's."""
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
