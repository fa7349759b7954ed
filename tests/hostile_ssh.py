"""SSH servers that misbehave at each stage: before the greeting, in the key exchange, at the login, in a channel."""

from __future__ import annotations

import random
import socket
import struct
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import paramiko

from pyfrc_core.deploy.discovery import Address

#: What a server does with a connection.
Serve = Callable[[socket.socket, threading.Event], None]

_GREETING = b"SSH-2.0-robot\r\n"
_KEX = [
    "curve25519-sha256@libssh.org",
    "ecdsa-sha2-nistp256",
    "aes128-ctr",
    "aes128-ctr",
    "hmac-sha2-256",
    "hmac-sha2-256",
]
_KEY = paramiko.ECDSAKey.generate()


@contextmanager
def serving(serve: Serve) -> Iterator[Address]:
    """Serve each connection in a thread of its own."""
    over = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def accept() -> None:
            while True:
                try:
                    connected = listener.accept()[0]
                except OSError:
                    return
                threading.Thread(target=one, args=(connected,), daemon=True).start()

        def one(connected: socket.socket) -> None:
            with connected, suppress(OSError, EOFError, paramiko.SSHException):  # the client may be gone
                serve(connected, over)

        threading.Thread(target=accept, daemon=True).start()
        try:
            yield Address("127.0.0.1", listener.getsockname()[1])
        finally:
            over.set()
            listener.shutdown(socket.SHUT_RDWR)


def packet(payload: bytes) -> bytes:
    """An SSH packet, as it is before there are keys."""
    padding = 8 - (5 + len(payload)) % 8 + (8 if (5 + len(payload)) % 8 > 4 else 0)
    return struct.pack(">IB", len(payload) + padding + 1, padding) + payload + bytes(padding)


def kex_init(*lists: str, tail: bytes = bytes(5)) -> bytes:
    """The packet that begins a key exchange."""
    names = [*lists, *_KEX[len(lists) :], "none", "none", "", ""]
    return packet(b"\x14" + bytes(16) + b"".join(struct.pack(">I", len(each)) + each.encode() for each in names) + tail)


def says(data: bytes, then: str = "close") -> Serve:
    """Send data, then close the connection, reset it, or be silent."""

    def serve(connected: socket.socket, over: threading.Event) -> None:
        connected.sendall(data)
        if then == "reset":
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        elif then == "close":
            connected.shutdown(socket.SHUT_WR)
            connected.settimeout(1.0)
            while connected.recv(4096):
                pass
        else:
            over.wait(30)

    return serve


def repeats(data: bytes, begin: bytes = b"", pause: float = 0.0) -> Serve:
    """Send the same for ever."""

    def serve(connected: socket.socket, over: threading.Event) -> None:
        connected.sendall(begin)
        while not over.wait(pause):
            connected.sendall(data)

    return serve


class _Server(paramiko.ServerInterface):
    """Lets users in or not, and opens channels or not.

    :param methods: how users may log in, as the server says
    :param login:   what comes of each attempt; ``sleep`` and ``close`` for no response
    :param opening: what comes of a request for a channel
    :param command: what comes of a command
    """

    def __init__(
        self,
        transport: paramiko.Transport,
        over: threading.Event,
        methods: str = "password",
        login: int | str = paramiko.AUTH_SUCCESSFUL,
        opening: int | str = paramiko.OPEN_SUCCEEDED,
        command: Callable[[paramiko.Channel, threading.Event], None] | str | None = None,
    ) -> None:
        self._transport, self._over = transport, over
        self._methods, self._login, self._opening, self._command = methods, login, opening, command

    def _result(self, result: int | str, refused: int) -> int:
        if result == "close":
            self._transport.close()
        elif result == "sleep":
            self._over.wait(30)
        elif isinstance(result, int):
            return result
        return refused

    def get_allowed_auths(self, username: str) -> str:
        return self._methods

    def check_auth_none(self, username: str) -> int:
        return self._result(self._login, paramiko.AUTH_FAILED)

    check_auth_password = lambda self, username, password: self.check_auth_none(username)  # noqa: E731
    check_auth_publickey = check_auth_password

    def check_channel_request(self, kind: str, chanid: int) -> int:
        return self._result(self._opening, paramiko.OPEN_FAILED_CONNECT_FAILED)

    def check_channel_exec_request(self, channel: paramiko.Channel, command: bytes) -> bool:
        if callable(self._command):
            threading.Thread(target=self._run, args=(channel,), daemon=True).start()
            return True
        self._result(self._command or "", 0)
        return False

    def _run(self, channel: paramiko.Channel) -> None:
        assert callable(self._command)
        self._over.wait(0.05)  # until the client knows that the command has begun
        with suppress(OSError, EOFError):
            self._command(channel, self._over)


def ssh(key: paramiko.PKey = _KEY, **options: object) -> Serve:
    """A server that speaks SSH; for the options see `_Server`."""

    def serve(connected: socket.socket, over: threading.Event) -> None:
        transport = paramiko.Transport(connected)
        transport.add_server_key(key)
        transport.start_server(server=_Server(transport, over, **options))  # type: ignore[arg-type]
        while transport.is_alive() and not over.wait(0.02):
            pass
        transport.close()

    return serve


def printing(data: bytes, status: int | None = 0, *, for_ever: bool = False, errors: bool = False) -> object:
    """A command that prints data, and ends with an exit code; None: it goes on, or ends without one."""

    def run(channel: paramiko.Channel, over: threading.Event) -> None:
        send = channel.sendall_stderr if errors else channel.sendall
        while True:
            send(data)
            if not for_ever or over.is_set():
                break
        if status is not None:
            channel.send_exit_status(status)
            channel.close()
        else:
            over.wait(30)

    return run


def garbage(seed: int, count: int = 300) -> bytes:
    return random.Random(seed).randbytes(count)
