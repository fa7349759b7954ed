"""One SSH connection to the robot, and commands run over it."""

from __future__ import annotations

import contextlib
import logging
import socket
import sys
import threading
from collections.abc import Callable
from functools import partial
from types import TracebackType
from typing import TYPE_CHECKING

from .credentials import NONE_OFFERED, Credentials
from .discovery import CONNECT_SECONDS, Address
from .errors import ConnectionFailedError, DeployError
from .host_keys import HostKey, Recognized, RobotKeys

if TYPE_CHECKING:
    import paramiko

PROGRAM_USER = "lvuser"
ADMINISTRATOR = "admin"
#: With this begins the greeting of a virtual robot's SSH server.
VIRTUAL_ROBOT_GREETING = "SSH-2.0-pyfrc_virtual_robot"

#: Seconds for each step of the way in: a roboRIO takes some for the first key exchange after its start.
_STEP_SECONDS = 15.0
#: Seconds between signs of life, and until a link without any counts as lost.
_ALIVE_SECONDS = 5
_LOST_SECONDS = 20
#: Bytes that a command of ours prints at most.
_MOST_PRINTED = 100_000

_CHECK_LINK = "Check the link (radio, cable, power of the robot) and run the command again."


def load_in_background() -> None:
    """Have paramiko imported, which takes a tenth of a second, while something else is waited for."""
    # Not a daemon: one that is in the middle of an import when Python ends takes it down.
    threading.Thread(target=_load).start()


def _load() -> None:
    # paramiko imports invoke, if it is there, for a clause of ~/.ssh/config; we read none, and it takes another tenth.
    absent = "invoke" not in sys.modules
    if absent:
        sys.modules["invoke"] = None  # type: ignore[assignment]
    try:
        import paramiko  # noqa: F401
    finally:
        if absent:
            del sys.modules["invoke"]


class Connection:
    """An SSH connection, open until `close`.

    :param transport: authenticated
    :param key: the robot's
    :param recognized: what is known of the key
    """

    def __init__(
        self,
        transport: paramiko.Transport,
        address: Address,
        key: HostKey,
        recognized: Recognized,
        again: Callable[[str], Connection],
    ) -> None:
        self._transport = transport
        self._again = again
        self.address = address
        self.key = key
        self.recognized = recognized

    def as_user(self, user: str) -> Connection:
        """Connect to the same robot once more, as another user.

        :raises HostKeyError: when another robot is at the address now
        :raises ConnectionFailedError: when it does not let that user in
        """
        return self._again(user)

    def administer(self, command: str) -> str | None:
        """Run a command as the administrator, over a connection of its own.

        :return: what went wrong; none: nothing
        """
        try:
            with self.as_user(ADMINISTRATOR) as administrator:
                status, printed = administrator.run(command)
        except (DeployError, OSError) as error:
            return str(error)
        return None if status == 0 else printed.strip() or f"exit code {status}"

    @property
    def is_virtual_robot(self) -> bool:
        """Whether its greeting says that it is one of ours."""
        return str(self._transport.remote_version).startswith(VIRTUAL_ROBOT_GREETING)

    @property
    def host(self) -> str:
        return self.address.host

    def open(self, command: str) -> paramiko.Channel:
        """Run a command on the robot: its input and output.

        :raises ConnectionFailedError: when the link is lost
        """
        import paramiko

        try:
            channel = self._transport.open_session(timeout=_STEP_SECONDS)
            channel.settimeout(_LOST_SECONDS)
            channel.exec_command(command)
        except (paramiko.SSHException, OSError, EOFError) as error:
            raise link_lost(self.address, error) from error
        return channel

    def run(self, command: str) -> tuple[int, str]:
        """The exit code of a command, and what it printed.

        :raises ConnectionFailedError: when the link is lost
        """
        with contextlib.closing(self.open(command)) as channel:
            channel.set_combine_stderr(True)
            printed = bytearray()
            try:
                while len(printed) < _MOST_PRINTED and (data := channel.recv(65536)):
                    printed += data
                known = channel.status_event.wait(_LOST_SECONDS)
                return channel.recv_exit_status() if known else -1, printed.decode(errors="replace")
            except (OSError, EOFError) as error:
                raise link_lost(self.address, error) from error

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
    keys: RobotKeys,
    *,
    user: str = PROGRAM_USER,
    connected: socket.socket | None = None,
    accepted_key: str | None = None,
    robot_name: str | None = None,
    pin: bool = True,
    credentials: Credentials = NONE_OFFERED,
) -> Connection:
    """Connect, compare the robot's key, log in, and pin the key if it is new.

    :param keys: that the robot may have
    :param connected: to the address already
    :param accepted_key: the fingerprint of a changed host key that the user accepts
    :param robot_name: a name to be kept with the robot's key
    :param pin: whether a key that is seen for the first time is pinned
    :param credentials: the user's own keys, offered to a robot that wants one
    :raises HostKeyError: when the robot's key is not one that it may have
    :raises ConnectionFailedError: when it does not let us in
    """
    import paramiko

    # What paramiko logs of a failure is told by the error.
    logging.getLogger("paramiko").setLevel(logging.CRITICAL)
    if connected is None:
        try:
            connected = socket.create_connection((address.host, address.port), timeout=CONNECT_SECONDS)
        except OSError as error:
            raise _not_let_in(address, error) from error
    _suit_a_radio(connected)
    transport = paramiko.Transport(connected)
    try:
        key = _greet(transport, keys)
        keys.check(key, accepted_key, robot_name, pin=False)
        _log_in(transport, address, user, credentials)
        # Only now: a stranger's server at a robot's address does not let us in, and its key must not become the team's.
        recognized = keys.check(key, accepted_key, robot_name, pin)
    except BaseException as error:
        transport.close()
        if isinstance(error, (paramiko.SSHException, OSError, EOFError)):
            raise _not_let_in(address, error) from error
        raise
    transport.set_keepalive(_ALIVE_SECONDS)
    again = partial(_connect_again, address, keys, key, credentials)
    return Connection(transport, address, key, recognized, again)


def _connect_again(address: Address, keys: RobotKeys, key: HostKey, credentials: Credentials, user: str) -> Connection:
    return connect(address, keys, user=user, accepted_key=key.fingerprint, pin=False, credentials=credentials)


def _suit_a_radio(connected: socket.socket) -> None:
    connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _LOST_SECONDS * 1000)


def _greet(transport: paramiko.Transport, keys: RobotKeys) -> HostKey:
    """Agree on encryption; return the server's key."""
    transport.banner_timeout = transport.handshake_timeout = transport.auth_timeout = _STEP_SECONDS
    options = transport.get_security_options()
    pinned = {known.key.kind for known in keys.known()}
    # The server has keys of several kinds: asked for one that is pinned, it shows that.
    options.key_types = sorted(options.key_types, key=lambda kind: _kind_of_key(kind) not in pinned)
    transport.start_client(timeout=_STEP_SECONDS)
    shown = transport.get_remote_server_key()
    return HostKey(shown.get_name(), shown.asbytes())


def _kind_of_key(algorithm: str) -> str:
    return "ssh-rsa" if algorithm.startswith("rsa-sha2-") else algorithm


def _log_in(transport: paramiko.Transport, address: Address, user: str, credentials: Credentials) -> None:
    import paramiko

    try:
        # Robots have no passwords, and let such users in at once.
        transport.auth_none(user)
        return
    except paramiko.BadAuthenticationType as refused:
        allowed = refused.allowed_types
    if "password" in allowed:
        with contextlib.suppress(paramiko.AuthenticationException):
            transport.auth_password(user, "", fallback=False)
            return
    offered = 0
    if "publickey" in allowed:
        for key in credentials.load():
            offered += 1
            with contextlib.suppress(paramiko.AuthenticationException):
                transport.auth_publickey(user, key)
                return
    raise _refused(address, user, allowed, offered, credentials)


def _refused(
    address: Address, user: str, allowed: list[str], offered: int, credentials: Credentials
) -> ConnectionFailedError:
    if offered:
        what = f"the robot refuses {user} with {credentials.offered(offered)}"
        remedy = "Offer the right key: --identity FILE, or ssh-add FILE and --ssh-agent."
    elif "password" in allowed:
        what = f"the robot refuses {user} with an empty password, which robots come with"
        remedy = (
            f"Remove the password that was set as admin, on the robot: passwd -d {user}; or image the robot again. Or "
            "is this another computer than the robot? Name the robot with --robot HOST."
        )
    else:
        what = f"the robot lets {user} in only with a key, and {credentials.offered(0)}"
        remedy = "Offer a key of yours: --identity FILE; or ssh-add FILE and --ssh-agent."
    return ConnectionFailedError(what, where=str(address), remedy=remedy)


def _not_let_in(address: Address, error: BaseException) -> ConnectionFailedError:
    what = str(error)
    if isinstance(error, EOFError) or what.startswith("Invalid packet"):
        what = "it began as an SSH server does, and then closed the connection or sent something else"
    return ConnectionFailedError(f"could not log in to the robot: {what}", where=str(address), remedy=_CHECK_LINK)


def link_lost(address: Address, error: BaseException) -> ConnectionFailedError:
    """The error for a link that broke."""
    what = str(error) or ("no answer" if isinstance(error, TimeoutError) else "the robot closed it")
    return ConnectionFailedError(f"the link to the robot was lost: {what}", where=str(address), remedy=_CHECK_LINK)
