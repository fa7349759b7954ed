"""Local sockets as macOS has them: each has a file, whose name is short."""

from __future__ import annotations

import errno
import socket
from collections.abc import Callable
from typing import Any

from .callers import Owner, caller

#: Bytes, with the zero at its end.
_LONGEST = 104


def install() -> None:
    """Replace the methods that take an address."""
    kind: Any = socket.socket
    for name in ("bind", "connect"):
        setattr(kind, name, _checked(getattr(kind, name)))


def _checked(method: Callable[..., Any]) -> Callable[..., Any]:
    def call(self: socket.socket, address: Any) -> Any:
        if self.family == socket.AF_UNIX and caller() is not Owner.SUITE:
            name = address.encode() if isinstance(address, str) else bytes(address)
            if name.startswith(b"\0"):
                raise FileNotFoundError(errno.ENOENT, "No such file or directory")
            if len(name) >= _LONGEST:
                raise OSError(63, "File name too long")
        return method(self, address)

    return call
