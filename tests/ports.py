"""Ports and addresses of this computer that nothing else uses while a test needs them."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def refusing_port() -> Iterator[int]:
    """A port of 127.0.0.1 that refuses connections until the end of the ``with`` block.

    It is bound, and nothing listens: the number of a socket that was closed may be another server's a moment later.
    """
    with socket.socket() as bound:
        bound.bind(("127.0.0.1", 0))
        yield bound.getsockname()[1]


def lasting_port() -> int:
    """Return a free port that stays free, since the system gives it to no connection, nor is it another worker's.

    :raises OSError: if all of them are in use
    """
    first = 20_000 + os.getpid() % 10_000
    for port in range(first, first + 1000):
        try:
            socket.create_server(("", port)).close()
        except OSError as error:
            failure = error
        else:
            return port
    raise failure


def address_without_servers() -> str:
    """Return a loopback address at which no other test serves anything, also not at a robot's fixed ports.

    Virtual robots have 127.0.0.1, and look-alikes the addresses up to 127.199. Only Linux has more than 127.0.0.1.
    """
    if sys.platform != "linux":
        return "127.0.0.1"
    number = os.getpid()
    return f"127.{200 + number // 62500 % 50}.{number // 250 % 250}.{2 + number % 250}"
