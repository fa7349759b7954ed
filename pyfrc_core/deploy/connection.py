"""One SSH connection to the robot, and commands run over it."""

from __future__ import annotations

import contextlib
import logging
import socket
import sys
import threading
from types import TracebackType
from typing import TYPE_CHECKING, Any

from .discovery import CONNECT_SECONDS, Address
from .errors import ConnectionFailedError
from .host_keys import HostKey, HostKeys

if TYPE_CHECKING:
    import paramiko

PROGRAM_USER = "lvuser"
ADMINISTRATOR = "admin"

#: Seconds for each step of the way in: a roboRIO takes some for the first key exchange after its start.
_STEP_SECONDS = 15.0
#: Seconds between signs of life, and until a link without any counts as lost.
_ALIVE_SECONDS = 5
_LOST_SECONDS = 20
#: An SSH server gives up after about so many keys.
_MOST_KEYS = 5

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
    """

    def __init__(self, transport: paramiko.Transport, address: Address, new_key: HostKey | None) -> None:
        self._transport = transport
        self.address = address
        #: The robot's key, where the project has seen it for the first time.
        self.new_key = new_key

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
                while data := channel.recv(65536):
                    printed += data
                return channel.recv_exit_status(), printed.decode(errors="replace")
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
    keys: HostKeys,
    *,
    user: str = PROGRAM_USER,
    connected: socket.socket | None = None,
    accepted_key: str | None = None,
) -> Connection:
    """Connect, compare the robot's key, and log in.

    :param connected: to the address already
    :param accepted_key: the fingerprint of a changed host key that the user accepts
    :raises HostKeyError: when the robot's key is not the one that the project knows
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
        new_key = _greet(transport, address, keys, accepted_key)
        _log_in(transport, address, user)
    except BaseException as error:
        transport.close()
        if isinstance(error, (paramiko.SSHException, OSError, EOFError)):
            raise _not_let_in(address, error) from error
        raise
    transport.set_keepalive(_ALIVE_SECONDS)
    return Connection(transport, address, new_key)


def _suit_a_radio(connected: socket.socket) -> None:
    connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _LOST_SECONDS * 1000)


def _greet(transport: paramiko.Transport, address: Address, keys: HostKeys, accepted_key: str | None) -> HostKey | None:
    """Agree on encryption; answer the server's key where it is new."""
    transport.banner_timeout = transport.handshake_timeout = transport.auth_timeout = _STEP_SECONDS
    options = transport.get_security_options()
    pinned = {key.kind for key in keys.known(address)}
    # The server has keys of several kinds: asked for one that is pinned, it shows that.
    options.key_types = sorted(options.key_types, key=lambda kind: _kind_of_key(kind) not in pinned)
    transport.start_client(timeout=_STEP_SECONDS)
    shown = transport.get_remote_server_key()
    key = HostKey(shown.get_name(), shown.asbytes())
    return key if keys.check(address, key, accepted_key) else None


def _kind_of_key(algorithm: str) -> str:
    return "ssh-rsa" if algorithm.startswith("rsa-sha2-") else algorithm


def _log_in(transport: paramiko.Transport, address: Address, user: str) -> None:
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
        for key in paramiko.Agent().get_keys()[:_MOST_KEYS]:
            offered += 1
            with contextlib.suppress(paramiko.AuthenticationException):
                transport.auth_publickey(user, key)
                return
    raise _refused(address, user, allowed, offered)


def _refused(address: Address, user: str, allowed: Any, offered: int) -> ConnectionFailedError:
    if "password" in allowed:
        return ConnectionFailedError(
            f"the robot refuses {user} with an empty password, which robots come with",
            where=str(address),
            remedy=f"Somebody has set one. Take it away as admin, on the robot: passwd -d {user}; or image the robot "
            "anew. Or is this another computer than the robot? Name the robot with --robot HOST.",
        )
    if offered:
        what, remedy = f"{offered} of your SSH agent's keys", "Add the right one to your agent: ssh-add FILE"
    else:
        what, remedy = "there is none in your SSH agent", "Start an agent and add the robot's key to it: ssh-add FILE"
    return ConnectionFailedError(
        f"the robot lets {user} in only with a key, and refuses what was offered: {what}"
        if offered
        else f"the robot lets {user} in only with a key, and {what}",
        where=str(address),
        remedy=remedy,
    )


def _not_let_in(address: Address, error: BaseException) -> ConnectionFailedError:
    what = str(error) or type(error).__name__
    return ConnectionFailedError(f"could not log in to the robot: {what}", where=str(address), remedy=_CHECK_LINK)


def link_lost(address: Address, error: BaseException) -> ConnectionFailedError:
    """The error for a link that broke."""
    what = str(error) or ("no answer" if isinstance(error, TimeoutError) else "the robot closed it")
    return ConnectionFailedError(f"the link to the robot was lost: {what}", where=str(address), remedy=_CHECK_LINK)
