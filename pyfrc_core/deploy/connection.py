"""An SSH connection to the robot, and commands over it."""

from __future__ import annotations

import contextlib
import logging
import socket
import threading
from collections.abc import Callable, Iterator
from importlib import import_module
from types import TracebackType
from typing import TYPE_CHECKING

from ..errors import PyfrcError
from .discovery import CONNECT_SECONDS, Address
from .errors import ConnectionFailedError, DeployError
from .host_keys import HostKey, Recognized, RobotKeys
from .login import NONE_OFFERED, STEP_SECONDS, Credentials, log_in
from .targets import AdministratorTask, ControllerKind

if TYPE_CHECKING:
    import paramiko


#: The first part of a virtual robot's SSH greeting.
VIRTUAL_ROBOT_GREETING = "SSH-2.0-pyfrc_virtual_robot"

#: Seconds between keep-alive packets, and until a silent connection counts as lost.
_ALIVE_SECONDS = 5
_LOST_SECONDS = 20
#: The maximum output of a command, in bytes.
_MAX_OUTPUT_BYTES = 100_000

#: What paramiko says of a server that does not speak SSH.
_NO_SESSION = ("Invalid packet", "Error reading SSH protocol banner", "Indecipherable protocol", "No existing session")
_CHECK_LINK = "Check the link (radio, cable, power of the robot) and run the command again."


def load_in_background() -> None:
    """Import paramiko, which takes 0.2 s, in a background thread."""
    # Not a daemon thread: Python crashes if it exits during an import.
    threading.Thread(target=import_module, args=["paramiko"]).start()


class Connection:
    """An SSH connection, open until `close`.

    :param transport: an authenticated transport
    :param controller: the kind of computer on the robot
    :param key: the robot's host key
    :param recognized: the result of the key check
    :param reconnect: connects to the same robot as another user
    """

    def __init__(
        self,
        transport: paramiko.Transport,
        address: Address,
        controller: ControllerKind,
        key: HostKey,
        recognized: Recognized,
        reconnect: Callable[[str], Connection],
    ) -> None:
        self._transport = transport
        self._reconnect = reconnect
        self.address = address
        self.controller = controller
        self.key = key
        self.recognized = recognized

    def as_user(self, user: str) -> Connection:
        """Open a second connection to the same robot, as another user.

        :raises HostKeyError: if another robot is at the address now
        :raises ConnectionFailedError: if the login fails
        """
        return self._reconnect(user)

    def administer(self, task: AdministratorTask) -> str | None:
        """Run a task as administrator, over a second connection.

        :return: the error, or None
        """
        try:
            with self.as_user(self.controller.layout.administrator) as administrator:
                status, printed = administrator.run(task.script)
        except (DeployError, OSError) as error:
            return str(error)
        return None if status == 0 else printed.strip() or f"exit code {status}"

    @property
    def is_virtual_robot(self) -> bool:
        """Return whether the robot is a virtual robot, according to its greeting."""
        return str(self._transport.remote_version).startswith(VIRTUAL_ROBOT_GREETING)

    def python(self, environment: str | None = None) -> str:
        """Return the beginning of a shell command: the Python that the current program starts with.

        :param environment: the name of an environment, whose Python is taken if it is complete
        """
        return self.controller.python if self.is_virtual_robot else self.controller.python_command(environment)

    @property
    def host(self) -> str:
        return self.address.host

    def open(self, command: str) -> paramiko.Channel:
        """Start a command on the robot, and return the channel with its input and output.

        :raises ConnectionFailedError: if the connection is lost
        """
        try:
            channel = self._transport.open_session(timeout=STEP_SECONDS)
            channel.settimeout(_LOST_SECONDS)
            limit = threading.Timer(STEP_SECONDS, _close, [channel])  # paramiko has none for the response
            limit.start()
            try:
                channel.exec_command(command)
            finally:
                limit.cancel()
        except Exception as error:  # paramiko raises what its thread has met: any, if the server violates the protocol
            if self._transport.is_active():
                what = f"the robot does not run commands over SSH: {getattr(error, 'text', error)}"
                raise ConnectionFailedError(what, where=str(self.address), remedy=_CHECK_LINK) from error
            raise connection_lost(self.address, error) from error
        return channel

    @contextlib.contextmanager
    def opened(self, command: str) -> Iterator[paramiko.Channel]:
        """Start a command on the robot, and close its channel after the ``with`` block."""
        channel = self.open(command)
        try:
            yield channel
        finally:
            _close(channel)

    def run(self, command: str) -> tuple[int, str]:
        """Run a command, and return its exit code and its output.

        :raises ConnectionFailedError: if the connection is lost
        """
        with self.opened(command) as channel:
            channel.set_combine_stderr(True)
            printed = bytearray()
            try:
                while len(printed) < _MAX_OUTPUT_BYTES and (data := channel.recv(65536)):
                    printed += data
                known = channel.status_event.wait(_LOST_SECONDS)
                return channel.recv_exit_status() if known else -1, printed.decode(errors="replace")
            except (OSError, EOFError) as error:
                raise connection_lost(self.address, error) from error

    def close(self) -> None:
        self._transport.close()

    def __enter__(self) -> Connection:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()


def connect(
    address: Address,
    controller: ControllerKind,
    keys: RobotKeys,
    *,
    user: str | None = None,
    connected: socket.socket | None = None,
    accepted_key: str | None = None,
    robot_name: str | None = None,
    pin: bool = True,
    credentials: Credentials = NONE_OFFERED,
) -> Connection:
    """Connect, check the robot's host key, log in, and pin the key if it is new.

    :param controller: the kind of computer on the robot
    :param keys: the robot's known keys
    :param user: default: the user who runs the robot program
    :param connected: a socket that is already connected to the address
    :param accepted_key: the fingerprint of a changed host key that the user accepts
    :param robot_name: a name to store with the robot's key
    :param pin: whether to pin a new key
    :param credentials: how to log in
    :raises HostKeyError: if the robot's key is not a known one
    :raises ConnectionFailedError: if the login fails
    :raises RefusedError: if the robot has another controller
    """
    # The error has the content of paramiko's log messages.
    logging.getLogger("paramiko").setLevel(logging.CRITICAL)
    try:
        if connected is None:
            connected = socket.create_connection((address.host, address.port), timeout=CONNECT_SECONDS)
        _set_socket_options(connected)
    except OSError as error:
        raise _not_let_in(address, error) from error
    import paramiko

    transport = paramiko.Transport(connected)
    try:
        key = _greet(transport, keys)
        keys.check(key, accepted_key, robot_name, pin=False)
        log_in(transport, address, controller, user or controller.layout.user, credentials, key)
        # Pinned only after the login, which fails at an unrelated server with a robot's address.
        recognized = keys.check(key, accepted_key, robot_name, pin)
    except BaseException as error:
        transport.close()
        if isinstance(error, Exception) and not isinstance(error, PyfrcError):
            raise _not_let_in(address, error) from error
        raise
    transport.set_keepalive(_ALIVE_SECONDS)

    def reconnect(user: str) -> Connection:
        accepted = key.fingerprint
        return connect(address, controller, keys, user=user, accepted_key=accepted, pin=False, credentials=credentials)

    return Connection(transport, address, controller, key, recognized, reconnect)


def _close(channel: paramiko.Channel) -> None:
    with contextlib.suppress(OSError, EOFError):  # the connection may be lost
        channel.close()


def _set_socket_options(connected: socket.socket) -> None:
    connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _LOST_SECONDS * 1000)


def _greet(transport: paramiko.Transport, keys: RobotKeys) -> HostKey:
    """Start the SSH session, and return the server's host key."""
    transport.banner_timeout = transport.handshake_timeout = transport.auth_timeout = STEP_SECONDS
    options = transport.get_security_options()
    pinned = {known.key.kind for known in keys.known()}
    # A server with keys of several kinds presents the first kind in this list.
    options.key_types = sorted(options.key_types, key=lambda kind: _kind_of_key(kind) not in pinned)
    transport.start_client(timeout=STEP_SECONDS)
    shown = transport.get_remote_server_key()
    return HostKey(shown.get_name(), shown.asbytes())


def _kind_of_key(algorithm: str) -> str:
    return "ssh-rsa" if algorithm.startswith("rsa-sha2-") else algorithm


def _not_let_in(address: Address, error: BaseException) -> ConnectionFailedError:
    import paramiko

    what = str(error)
    if not isinstance(error, (paramiko.SSHException, OSError)) or what.startswith(_NO_SESSION):
        what = "the server closed the connection, did not respond in time, or violated the SSH protocol"
    return ConnectionFailedError(f"could not log in to the robot: {what}", where=str(address), remedy=_CHECK_LINK)


def connection_lost(address: Address, error: BaseException) -> ConnectionFailedError:
    """Return the error for a lost connection."""
    what = str(error) or ("no response" if isinstance(error, TimeoutError) else "the robot closed it")
    return ConnectionFailedError(
        f"the connection to the robot was lost: {what}", where=str(address), remedy=_CHECK_LINK
    )
