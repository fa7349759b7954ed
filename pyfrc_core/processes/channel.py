"""What a process sends over a connection of its own: its messages in their order, then its exit.

For processes that another one has started for this one: their exit is reported from another side. So the exit is held
back until the connection has been read to its end; no time limit decides which comes first.
"""

from __future__ import annotations

import os
import socket
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any


def receive(connection: Connection) -> Any:
    """Return the next object; a function, for tests that need one side to be late."""
    return connection.recv()


class Channel:
    """What one process sends.

    :param number: which process it is
    :param on_message: called with the number and each message
    :param on_exit: called with the number and the exit code, after the last message
    """

    def __init__(
        self, number: int, on_message: Callable[[int, Any], object], on_exit: Callable[[int, int], object]
    ) -> None:
        self._number, self._on_message, self._on_exit = number, on_message, on_exit
        self._lock = threading.Lock()
        self._over = False
        self.connection: Connection | None = None
        self._reader: threading.Thread | None = None

    def connected(self, connection: Connection) -> None:
        """Read the messages that come over this connection."""
        self.connection = connection
        self._reader = threading.Thread(target=self._read, args=(connection,), name="pyfrc: messages", daemon=True)
        self._reader.start()

    def ended(self, status: int) -> None:
        """Report the exit of the process, after its last message. Only the first call counts.

        Call this when the process has ended, and `connected` can be called no more.
        """
        with self._lock:
            if self._over:
                return
            self._over = True
        if self._reader is not None and self.connection is not None:
            end_of_input(self.connection)
            self._reader.join()
            self.connection.close()
        self._on_exit(self._number, status)

    def _read(self, connection: Connection) -> None:
        with suppress(OSError, EOFError):
            while True:
                self._on_message(self._number, receive(connection))


def end_of_input(connection: Connection) -> None:
    """Have a connection end where its other process, which is gone, has ended it.

    A process that robot code has forked may hold it open. Python's own forks close it (`close_in_forks`).
    """
    if sys.platform == "linux":  # elsewhere, it would throw away what has not been read yet
        with suppress(OSError), socket.socket(fileno=os.dup(connection.fileno())) as ours:
            ours.shutdown(socket.SHUT_RD)


def end_of_output(connection: Connection) -> None:
    """Have everything that was sent reach the other side before this process ends.

    Over TCP, a process that ends with unread commands takes back what it has not transmitted yet: the last message,
    while the one before it is not acknowledged.
    """
    if os.name == "posix":
        with suppress(OSError), socket.socket(fileno=os.dup(connection.fileno())) as ours:
            ours.shutdown(socket.SHUT_WR)


def close_in_forks(connection: Connection) -> None:
    """Have no fork of this process hold a connection open."""
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=connection.close)
