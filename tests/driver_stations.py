"""A Driver Station on this computer."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress


@contextmanager
def driver_station(port: int, says: Mapping[str, object]) -> Iterator[None]:
    """A Driver Station that says this to each program that connects to its port."""
    said = json.dumps(says).encode() + b"\n"
    with _alone_on_port(port) as listener:

        def serve() -> None:
            with suppress(OSError):
                while True:
                    with listener.accept()[0] as connected:
                        connected.sendall(said)

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        try:
            yield
        finally:  # or the thread would go on accepting, and no other test could ever listen there
            listener.shutdown(socket.SHUT_RDWR)
            thread.join()


def _alone_on_port(port: int) -> socket.socket:
    """Listens there, when it is this test's turn: another run of this suite may be at the same test."""
    for _ in range(2000):
        try:
            return socket.create_server(("127.0.0.1", port))
        except OSError:
            threading.Event().wait(0.1)
    raise AssertionError(f"port {port} is in use all the time: by a Driver Station?")
