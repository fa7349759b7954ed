"""An SSH connection to the robot, and commands over it."""

from __future__ import annotations

import contextlib
import logging
import socket
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from .discovery import CONNECT_SECONDS, Address
from .errors import ConnectionFailedError, DeployError, RefusedError
from .host_keys import HostKey, Recognized, RobotKeys
from .targets import AdministratorTask, ControllerKind

if TYPE_CHECKING:
    import paramiko


#: SSH servers usually disconnect after more keys.
_MAX_KEYS = 5


@dataclass(frozen=True)
class Credentials:
    """The keys to offer.

    :param identity: a file with a private key without a passphrase
    :param ssh_agent: whether to offer the keys of the SSH agent
    """

    identity: Path | None = None
    ssh_agent: bool = False

    def load(self) -> Iterator[paramiko.PKey]:
        """Yield the keys to offer, the identity first.

        :raises RefusedError: if the file has no readable key
        """
        if self.identity is not None:
            yield _key_in(self.identity)
        if self.ssh_agent:
            import paramiko

            agent = paramiko.Agent()
            try:
                yield from agent.get_keys()[:_MAX_KEYS]
            finally:
                agent.close()

    def offered(self, count: int) -> str:
        """Return a description of the offered keys, for an error message."""
        if count == 0:
            return "there is none in your SSH agent" if self.ssh_agent else "none was offered"
        sources = [str(self.identity)] if self.identity is not None else []
        if of_agent := count - len(sources):
            sources.append(f"{of_agent} of your SSH agent's keys")
        return " and ".join(sources)


NONE_OFFERED = Credentials()


def _key_in(file: Path) -> paramiko.PKey:
    import paramiko

    try:
        return paramiko.PKey.from_path(file)
    except (paramiko.PasswordRequiredException, TypeError):  # cryptography raises TypeError for this
        raise RefusedError(
            "this key has a passphrase",
            where=file,
            remedy="Add it to your SSH agent: ssh-add FILE, and use --ssh-agent.",
        ) from None
    except OSError as error:
        raise RefusedError(f"this key cannot be read: {error.strerror or error}", where=file) from None
    except Exception as error:  # invalid content causes many kinds of errors
        raise RefusedError(
            f"this is not a private key: {error}", where=file, remedy="Use the file without .pub at its end."
        ) from None


#: The first part of a virtual robot's SSH greeting.
VIRTUAL_ROBOT_GREETING = "SSH-2.0-pyfrc_virtual_robot"

#: Time limit for each step of the login, in seconds. The first key exchange after a robot's start is slow.
_STEP_SECONDS = 15.0
#: Seconds between keep-alive packets, and until a silent connection counts as lost.
_ALIVE_SECONDS = 5
_LOST_SECONDS = 20
#: The maximum output of a command, in bytes.
_MAX_OUTPUT_BYTES = 100_000

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

    @property
    def host(self) -> str:
        return self.address.host

    def open(self, command: str) -> paramiko.Channel:
        """Start a command on the robot, and return the channel with its input and output.

        :raises ConnectionFailedError: if the connection is lost
        """
        import paramiko

        try:
            channel = self._transport.open_session(timeout=_STEP_SECONDS)
            channel.settimeout(_LOST_SECONDS)
            channel.exec_command(command)
        except (paramiko.SSHException, OSError, EOFError) as error:
            raise connection_lost(self.address, error) from error
        return channel

    def run(self, command: str) -> tuple[int, str]:
        """Run a command, and return its exit code and its output.

        :raises ConnectionFailedError: if the connection is lost
        """
        with contextlib.closing(self.open(command)) as channel:
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
    :param credentials: the user's own keys, for a robot that requires one
    :raises HostKeyError: if the robot's key is not a known one
    :raises ConnectionFailedError: if the login fails
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
        _log_in(transport, address, controller, user or controller.layout.user, credentials)
        # Pinned only after the login, which fails at an unrelated server with a robot's address.
        recognized = keys.check(key, accepted_key, robot_name, pin)
    except BaseException as error:
        transport.close()
        if isinstance(error, (paramiko.SSHException, OSError, EOFError)):
            raise _not_let_in(address, error) from error
        raise
    transport.set_keepalive(_ALIVE_SECONDS)

    def reconnect(user: str) -> Connection:
        accepted = key.fingerprint
        return connect(address, controller, keys, user=user, accepted_key=accepted, pin=False, credentials=credentials)

    return Connection(transport, address, controller, key, recognized, reconnect)


def _set_socket_options(connected: socket.socket) -> None:
    connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _LOST_SECONDS * 1000)


def _greet(transport: paramiko.Transport, keys: RobotKeys) -> HostKey:
    """Start the SSH session, and return the server's host key."""
    transport.banner_timeout = transport.handshake_timeout = transport.auth_timeout = _STEP_SECONDS
    options = transport.get_security_options()
    pinned = {known.key.kind for known in keys.known()}
    # A server with keys of several kinds presents the first kind in this list.
    options.key_types = sorted(options.key_types, key=lambda kind: _kind_of_key(kind) not in pinned)
    transport.start_client(timeout=_STEP_SECONDS)
    shown = transport.get_remote_server_key()
    return HostKey(shown.get_name(), shown.asbytes())


def _kind_of_key(algorithm: str) -> str:
    return "ssh-rsa" if algorithm.startswith("rsa-sha2-") else algorithm


def _log_in(
    transport: paramiko.Transport, address: Address, controller: ControllerKind, user: str, credentials: Credentials
) -> None:
    import paramiko

    try:
        # Robots without passwords accept these users without authentication.
        transport.auth_none(user)
        return
    except paramiko.BadAuthenticationType as refused:
        allowed = refused.allowed_types
    if "password" in allowed:
        with contextlib.suppress(paramiko.AuthenticationException):
            transport.auth_password(user, controller.password, fallback=False)
            return
    offered = 0
    if "publickey" in allowed:
        for key in credentials.load():
            offered += 1
            with contextlib.suppress(paramiko.AuthenticationException):
                transport.auth_publickey(user, key)
                return
    raise _refused(address, controller, user, allowed, offered, credentials)


def _refused(
    address: Address,
    controller: ControllerKind,
    user: str,
    allowed: list[str],
    offered: int,
    credentials: Credentials,
) -> ConnectionFailedError:
    if offered:
        what = f"the robot refuses {user} with {credentials.offered(offered)}"
        remedy = "Offer the right key: --identity FILE, or ssh-add FILE and --ssh-agent."
    elif "password" in allowed:
        if controller.password:
            what = f"the robot refuses {user} with the password {controller.password}, which is the default on robots"
            remedy = f"Set the password on the robot: passwd {user}; or image the robot again."
        else:
            what = f"the robot refuses {user} with an empty password, which is the default on robots"
            administrator = controller.layout.administrator
            remedy = (
                f"Remove the password, as {administrator} on the robot: passwd -d {user}; or image the robot again."
            )
        remedy += " If this is not the robot, give its address with --robot HOST."
    else:
        what = f"the robot lets {user} in only with a key, and {credentials.offered(0)}"
        remedy = "Offer a key of yours: --identity FILE; or ssh-add FILE and --ssh-agent."
    return ConnectionFailedError(what, where=str(address), remedy=remedy)


def _not_let_in(address: Address, error: BaseException) -> ConnectionFailedError:
    what = str(error)
    if isinstance(error, EOFError) or what.startswith("Invalid packet"):
        what = "the server closed the connection, or violated the SSH protocol"
    return ConnectionFailedError(f"could not log in to the robot: {what}", where=str(address), remedy=_CHECK_LINK)


def connection_lost(address: Address, error: BaseException) -> ConnectionFailedError:
    """Return the error for a lost connection."""
    what = str(error) or ("no response" if isinstance(error, TimeoutError) else "the robot closed it")
    return ConnectionFailedError(
        f"the connection to the robot was lost: {what}", where=str(address), remedy=_CHECK_LINK
    )
