"""A server through which deploy agents stop and start the virtual robot's program."""

from __future__ import annotations

import json
import secrets
import socketserver
import threading
from typing import Any

from .supervisor import Supervisor

#: Seconds after which a client that sends or reads nothing is disconnected, and the longest request in bytes.
_LIMIT_SECONDS = 10.0
_LIMIT_BYTES = 200


class Control(socketserver.ThreadingTCPServer):
    """The server, in threads of its own until `close`.

    A request is one line: the key, a space, and what to do. The response is the list of the program's processes, as
    JSON.

    :param supervisor: starts and stops the program
    """

    daemon_threads = True
    block_on_close = False
    request_queue_size = 16  # agents of several laptops may connect at the same time

    def __init__(self, supervisor: Supervisor) -> None:
        super().__init__(("127.0.0.1", 0), _Request)
        self.supervisor = supervisor
        #: The authentication key for agents, in hexadecimal.
        self.key = secrets.token_hex(32)
        self.port = int(self.socket.getsockname()[1])
        threading.Thread(target=self.serve_forever, name="virtual robot: control", daemon=True).start()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing: a client has disconnected, or was too slow."""

    def close(self) -> None:
        """Stop the server."""
        self.shutdown()
        self.server_close()


class _Request(socketserver.StreamRequestHandler):
    timeout = _LIMIT_SECONDS
    server: Control

    def handle(self) -> None:
        key, _, request = self.rfile.readline(_LIMIT_BYTES).strip().partition(b" ")
        if not secrets.compare_digest(key, self.server.key.encode()):
            return
        supervisor = self.server.supervisor
        if request == b"stop":
            supervisor.stop()
        elif request == b"restart":
            supervisor.restart()
        self.wfile.write(json.dumps(supervisor.processes()).encode())
