"""Sends messages to a process that may not read them for long, such as one whose robot code hangs."""

from __future__ import annotations

import pickle
import select
import sys
import threading
from collections import deque
from contextlib import suppress
from multiprocessing.connection import Connection

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
