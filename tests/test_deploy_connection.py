"""Servers that begin as an SSH server does and are none, or go away: told in a sentence, at once."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from pyfrc_core.deploy.connection import connect, load_in_background
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import ConnectionFailedError
from pyfrc_core.deploy.host_keys import KNOWN_HOSTS, HostKeys


@contextmanager
def server(says: bytes) -> Iterator[Address]:
    """Says this to whoever connects, and hangs up."""
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve() -> None:
            with listener.accept()[0] as connected, suppress(ConnectionError):
                connected.sendall(says)
                connected.shutdown(socket.SHUT_WR)
                while connected.recv(4096):
                    pass

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        yield Address("127.0.0.1", listener.getsockname()[1])
        thread.join()


@pytest.mark.parametrize(
    "says",
    [
        b"",
        b"SSH-2.0-robot\r\n",
        b"SSH-1.5-old\r\n",
        b"SSH-2.0-robot\r\n" + b"\xff" * 64,
        b"SSH-2.0-robot\r\n" + b"\0" * 64,
        b"220 mail\r\n" * 200,
    ],
)
def test_what_is_no_ssh_server_is_told(says: bytes, tmp_path: Path) -> None:
    load_in_background()
    with server(says) as address, pytest.raises(ConnectionFailedError) as caught:
        connect(address, HostKeys(tmp_path))
    assert str(caught.value).startswith(f"{address}: could not log in to the robot: ")
    assert "Check the link" in str(caught.value)
    assert not (tmp_path / KNOWN_HOSTS).exists()


def test_nobody_at_the_address_is_told(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = Address("127.0.0.1", listener.getsockname()[1])
    with pytest.raises(ConnectionFailedError, match="refused"):
        connect(address, HostKeys(tmp_path))
