"""What a process sends over a connection of its own: its messages in their order, then its exit.

For processes that another one has started for this one: their exit is reported from another side. So the exit is held
back until the connection has been read to its end; no time limit decides which comes first.

An `Outbox` sends messages the other way, to a process that may not read them for long, as when its robot code hangs.
"""

from __future__ import annotations

import os
import pickle
import select
import socket
import sys
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Any

if sys.platform == "win32":
    from multiprocessing import connection as connections
    from typing import TypeAlias

    Connection: TypeAlias = connections.Connection | connections.PipeConnection
else:
    from multiprocessing.connection import Connection as Connection


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


#: What the buffer of a connection that takes anything at all has room for, in bytes.
_SURE_BYTES = 2048


class Outbox:
    """One end of a connection; sending never waits for the other end.

    Messages are sent at once as long as the other process reads. Otherwise they wait, and a thread sends them in their
    order. That ends when the other process, or this one, does.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._lock = threading.Lock()
        self._waiting: deque[bytes] = deque()
        #: Whether a thread sends what waits.
        self._late = False

    def send(self, message: object) -> None:
        """Send a message; nothing if the other end is gone."""
        data = pickle.dumps(message)
        with self._lock, suppress(OSError):
            if not self._late and len(data) <= _SURE_BYTES and _takes_more(self._connection):
                self._connection.send_bytes(data)
                return
            self._waiting.append(data)
            if not self._late:
                self._late = True
                threading.Thread(target=self._send_waiting, name="pyfrc: waiting messages", daemon=True).start()

    def _send_waiting(self) -> None:
        while True:
            with self._lock:
                if not self._waiting:
                    self._late = False
                    return
                data = self._waiting.popleft()
            with suppress(OSError):
                self._connection.send_bytes(data)


def _takes_more(connection: Connection) -> bool:
    """Return whether a small message can be sent without waiting, as far as the system says."""
    if sys.platform == "win32":  # pipes
        return False
    poll = select.poll()
    poll.register(connection.fileno(), select.POLLOUT)
    return bool(poll.poll(0))
