"""The console service of a robot: sends what the robot program prints to all who listen. Standard library only."""

from __future__ import annotations

import socket
import struct
import threading
import time
from contextlib import suppress

#: The console's port on a robot.
PORT = 1741

_TEXT = 12
_LONGEST = 65000
#: Seconds for which a listener that reads nothing may hold the program's output.
_PATIENCE = 1.0


def framed(line: bytes, number: int) -> bytes:
    """Return a line of output as the console frames it: length, kind, time in seconds, number, text."""
    body = struct.pack(">BfH", _TEXT, time.monotonic() % 1e6, number % 65536) + line[:_LONGEST]
    return struct.pack(">H", len(body)) + body


class Console:
    """A console on this computer.

    :param host: the loopback address at which it listens; at another port than a robot's when that is taken
    """

    def __init__(self, host: str) -> None:
        try:
            self._server = socket.create_server((host, PORT))
        except OSError:
            self._server = socket.create_server((host, 0))
        self.port: int = self._server.getsockname()[1]
        self._listeners: list[socket.socket] = []
        self._lock = threading.Lock()
        self._number = 0
        threading.Thread(target=self._accept, name="virtual robot: console", daemon=True).start()

    def send(self, line: bytes) -> None:
        """Send a line to all who listen."""
        with self._lock:
            self._number += 1
            for listener in list(self._listeners):
                try:
                    listener.sendall(framed(line, self._number))
                except OSError:
                    self._listeners.remove(listener)
                    listener.close()

    def close(self) -> None:
        """Hang up."""
        close_server(self._server)
        with self._lock:
            for listener in self._listeners:
                listener.close()
            self._listeners.clear()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                listener, _ = self._server.accept()
                listener.settimeout(_PATIENCE)
                with self._lock:
                    self._listeners.append(listener)


def close_server(server: socket.socket) -> None:
    """Close a listening socket, and end the `accept` of another thread."""
    with suppress(OSError):
        server.shutdown(socket.SHUT_RDWR)
    server.close()
