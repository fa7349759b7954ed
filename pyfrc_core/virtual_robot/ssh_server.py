"""The virtual robot's SSH server: it accepts a robot's users without a password, and runs Python commands.

It has no shell, since Windows has none. A deploy needs only Python commands. A
robot accepts every user. A virtual robot runs programs as its own user, so it must reject other users of the same
computer, and identifies the user at the other end. Only
Linux provides the user of a connection; on other systems, all users of the computer are accepted.
"""

from __future__ import annotations

import logging
import os
import shlex
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import paramiko
from paramiko import Channel, PKey, Transport
from paramiko.common import (
    AUTH_FAILED,
    AUTH_SUCCESSFUL,
    OPEN_FAILED_ADMINISTRATIVELY_PROHIBITED,
    OPEN_SUCCEEDED,
)

from ..deploy.agent.robot_paths import RobotPaths
from ..deploy.connection import VIRTUAL_ROBOT_GREETING
from ..processes.groups import kill_group
from . import children
from .console import close_server

_TABLE = Path("/proc/net/tcp")


def is_other_user(connection: socket.socket) -> bool:
    """Return whether the other end of a loopback connection belongs to another user; False if unknown."""
    if sys.platform != "linux":
        return False
    ends = [_as_in_table(*connection.getpeername()), _as_in_table(*connection.getsockname())]
    try:
        rows = [line.split() for line in _TABLE.read_text(encoding="utf-8").splitlines()]
    except OSError:
        return False
    users = [int(row[7]) for row in rows if row[1:3] == ends]
    return any(user not in (os.geteuid(), 0) for user in users)


def _as_in_table(host: str, port: int) -> str:
    return f"{int.from_bytes(socket.inet_aton(host), sys.byteorder):08X}:{port:04X}"


_NOT_FOUND = 127  # a shell's exit code for a command that does not exist
_SIGNALLED = 128  # a shell adds the signal's number to this exit code
_STEP_SECONDS = 15.0
_PAUSE_SECONDS = 0.1  # after a connection that could not be accepted


class SshServer:
    """An SSH server at a listening socket, until `close`.

    :param key:         the robot's host key
    :param console:     the port of its console, which is part of the server's greeting
    :param paths:       its files; its users log in, and commands begin in the home directory
    :param password:    of its users; empty: they log in without one
    :param environment: the environment variables of commands
    """

    def __init__(
        self,
        listening: socket.socket,
        key: PKey,
        console: int,
        paths: RobotPaths,
        password: str,
        environment: Mapping[str, str],
    ) -> None:
        # Clients that only search for a robot disconnect immediately, which is normal.
        logging.getLogger("paramiko").setLevel(logging.CRITICAL)
        self._listening = listening
        self._key = key
        self._greeting = f"{VIRTUAL_ROBOT_GREETING} console={console}"
        self._home = paths.home
        self._users = (paths.layout.user, paths.layout.administrator)
        self._password = password
        self._environment = environment
        self._closed = threading.Event()
        self._lock = threading.Lock()
        self._transports: set[Transport] = set()
        self._processes: set[subprocess.Popen[bytes]] = set()
        threading.Thread(target=self._accept, name="virtual robot: SSH server", daemon=True).start()

    def close(self) -> None:
        """Close all connections, and kill their commands."""
        self._closed.set()
        close_server(self._listening)
        with self._lock:
            transports, processes = list(self._transports), list(self._processes)
        for transport in transports:
            transport.close()
        for process in processes:
            kill_group(process)
            process.wait()

    def _accept(self) -> None:
        while not self._closed.is_set():
            try:
                connected, _ = self._listening.accept()
            except OSError:  # it is closed; or the client is gone again; or too many files are open
                self._closed.wait(_PAUSE_SECONDS)
                continue
            threading.Thread(target=self._greet, args=(connected,), daemon=True).start()

    def _greet(self, connected: socket.socket) -> None:
        if is_other_user(connected):
            connected.close()
            return
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        transport = paramiko.Transport(connected)
        transport.local_version = self._greeting
        transport.add_server_key(self._key)
        transport.handshake_timeout = transport.auth_timeout = _STEP_SECONDS
        with self._lock:
            self._transports = {each for each in self._transports if each.is_alive()} | {transport}
        try:
            transport.start_server(server=_Session(self._run, self._users, self._password))
        except (paramiko.SSHException, OSError, EOFError):
            transport.close()

    def _run(self, channel: Channel, command: str) -> None:
        """Run a command, with the channel as its input and output."""
        with suppress(OSError, EOFError):  # the laptop has disconnected
            words = _words(command)
            if not words or not Path(words[0]).name.startswith("python3"):
                channel.sendall_stderr(f"a virtual robot runs only Python, not: {command}\n".encode())
                channel.send_exit_status(_NOT_FOUND)
            else:
                channel.send_exit_status(self._run_python(channel, words[1:]))
        channel.close()

    def _run_python(self, channel: Channel, words: list[str]) -> int:
        process = children.start([sys.executable, *words], self._home, self._environment, stderr=subprocess.PIPE)
        with self._lock:
            self._processes.add(process)
        threading.Thread(target=_feed, args=(channel, process), daemon=True).start()
        errors = threading.Thread(target=_send_errors, args=(channel, process), daemon=True)
        errors.start()
        try:
            assert process.stdout is not None
            while data := process.stdout.read(65536):
                channel.sendall(data)
            process.stdout.close()
            errors.join()
            code = process.wait()
            return code if code >= 0 else _SIGNALLED - code
        finally:
            if process.poll() is None:
                children.end(process)
            with self._lock:
                self._processes.discard(process)


def _words(command: str) -> list[str]:
    try:
        return shlex.split(command)
    except ValueError:
        return []


def _feed(channel: Channel, process: subprocess.Popen[bytes]) -> None:
    assert process.stdin is not None
    with suppress(OSError, EOFError), process.stdin:
        while data := channel.recv(65536):
            view = memoryview(data)
            while view:  # the pipe is unbuffered, and may accept only a part
                view = view[process.stdin.write(view) :]


def _send_errors(channel: Channel, process: subprocess.Popen[bytes]) -> None:
    assert process.stderr is not None
    with suppress(OSError, EOFError), process.stderr:
        while data := process.stderr.read(65536):
            channel.sendall_stderr(data)


class _Session(paramiko.ServerInterface):
    """The policy for one connection: users and requests.

    :param run: runs a command with a channel as its input and output
    :param users: the users who may log in
    :param password: their password; empty: they log in without one
    """

    def __init__(self, run: Callable[[Channel, str], None], users: Sequence[str], password: str) -> None:
        self._run = run
        self._users = users
        self._password = password

    def get_allowed_auths(self, username: str) -> str:
        return "password"

    def check_auth_none(self, username: str) -> int:
        return self.check_auth_password(username, "")

    def check_auth_password(self, username: str, password: str) -> int:
        return AUTH_SUCCESSFUL if username in self._users and password == self._password else AUTH_FAILED

    def check_channel_request(self, kind: str, chanid: int) -> int:
        return OPEN_SUCCEEDED if kind == "session" else OPEN_FAILED_ADMINISTRATIVELY_PROHIBITED

    def check_channel_exec_request(self, channel: Channel, command: bytes) -> bool:
        text = command.decode(errors="replace")
        threading.Thread(target=self._run, args=(channel, text), daemon=True).start()
        return True
