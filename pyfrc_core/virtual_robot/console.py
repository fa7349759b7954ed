"""A robot's console service, which sends the robot program's output to all clients."""

from __future__ import annotations

import socket
import threading
import time
from contextlib import suppress

from ..deploy.agent.console import PORTS, text_frame

#: Seconds for which clients that read nothing may delay a line, all together, before they are disconnected.
_SEND_SECONDS = 1.0


class ConsoleServer:
    """A console server on this computer. It uses a free port if the usual one is taken.

    :param host: the loopback address at which it listens
    """

    def __init__(self, host: str) -> None:
        try:
            self._server = socket.create_server((host, PORTS[0]))
        except OSError:
            self._server = socket.create_server((host, 0))
        self._server.setblocking(False)
        self.port: int = self._server.getsockname()[1]
        self._clients: list[socket.socket] = []
        self._lock = threading.Lock()
        self._number = 0

    def send(self, line: bytes) -> None:
        """Send a line to all clients that have connected before."""
        with self._lock:
            self._accept()
            self._number += 1
            deadline = time.monotonic() + _SEND_SECONDS
            for client in list(self._clients):
                try:
                    client.settimeout(max(0.0, deadline - time.monotonic()))
                    client.sendall(text_frame(line, self._number))
                except OSError:
                    self._clients.remove(client)
                    client.close()

    def close(self) -> None:
        """Stop the server and disconnect all clients."""
        close_server(self._server)
        with self._lock:
            for client in self._clients:
                client.close()
            self._clients.clear()

    def _accept(self) -> None:
        """Accept the waiting clients.

        Only here: a thread that accepts clients may be late, and the first lines of a program would not reach the
        agent that has connected and then restarted it.
        """
        with suppress(OSError):  # none is waiting, or the server is closed
            while True:
                client, _ = self._server.accept()
                self._clients.append(client)


def close_server(server: socket.socket) -> None:
    """Close a listening socket, and end `accept` in another thread."""
    with suppress(OSError):
        server.shutdown(socket.SHUT_RDWR)
    server.close()
