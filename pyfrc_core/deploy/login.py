"""Logging in to the robot: with the default password, with the user's own keys, or with a password that is typed."""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..season import CURRENT
from .discovery import CONNECT_SECONDS, Address
from .errors import ConnectionFailedError, RefusedError
from .host_keys import HostKey
from .targets import CONTROLLERS, ControllerKind

if TYPE_CHECKING:
    import paramiko

#: Time limit for each step of the login, in seconds. The first key exchange after a robot's start is slow.
STEP_SECONDS = 15.0
#: SSH servers usually disconnect after more keys.
_MAX_KEYS = 5


@dataclass(frozen=True)
class Credentials:
    """The keys and the password to offer.

    :param identity: a file with a private key without a passphrase
    :param ssh_agent: whether to offer the keys of the SSH agent
    :param ask_password: asks the user for the password of a robot that is named, once for each robot; None if the user
        cannot be asked
    """

    identity: Path | None = None
    ssh_agent: bool = False
    ask_password: Callable[[str], str] | None = None

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
    except paramiko.SSHException as error:  # it cannot read some valid keys of ECDSA
        raise RefusedError(
            f"paramiko cannot read this key: {error}",
            where=file,
            remedy="Add it to your SSH agent: ssh-add FILE, and use --ssh-agent. Or take a key of Ed25519.",
        ) from None
    except Exception as error:  # invalid content causes many kinds of errors
        raise RefusedError(
            f"this is not a private key: {error}", where=file, remedy="Use the file without .pub at its end."
        ) from None


def log_in(
    transport: paramiko.Transport,
    address: Address,
    controller: ControllerKind,
    user: str,
    credentials: Credentials,
    key: HostKey,
) -> None:
    """Log in with the default password, with a key, or with a password for which the user is asked.

    :param key: the robot's, which the question names
    :raises ConnectionFailedError: if the robot refuses all of them
    :raises RefusedError: if it has another controller
    """
    import paramiko

    allowed = _try_password(transport, user, controller.password)
    if allowed is None:
        return
    offered = 0
    if "publickey" in allowed:
        for own in credentials.load():
            offered += 1
            with contextlib.suppress(paramiko.AuthenticationException):
                transport.auth_publickey(user, own)
            if transport.is_authenticated():
                return
    _refuse_other_controller(address, controller)  # before a question that cannot help
    if "password" in allowed and controller.password and credentials.ask_password is not None:
        with contextlib.suppress(paramiko.AuthenticationException):
            password = credentials.ask_password(f"{user}@{address} (its key: {key.fingerprint})")
            transport.auth_password(user, password, fallback=False)
        if transport.is_authenticated():
            return
    raise _refused(address, controller, user, allowed, offered, credentials)


def _try_password(transport: paramiko.Transport, user: str, password: str) -> list[str] | None:
    """Log in as a user with a robot's default password, or without any.

    :return: None after the login, else the ways to log in that the server allows
    """
    import paramiko

    try:
        # Robots without passwords accept their users without authentication.
        allowed = transport.auth_none(user)
    except paramiko.BadAuthenticationType as refused:
        allowed = refused.allowed_types
    if "password" in allowed:
        with contextlib.suppress(paramiko.AuthenticationException):
            transport.auth_password(user, password, fallback=False)
    return None if transport.is_authenticated() else allowed


def _refuse_other_controller(address: Address, controller: ControllerKind) -> None:
    """Check that the robot has no other controller: that it does not let that one's user in.

    :raises RefusedError: if it does
    """
    import paramiko

    for other in CONTROLLERS:
        if other is controller:
            continue
        with contextlib.suppress(paramiko.SSHException, OSError, EOFError):
            connected = socket.create_connection((address.host, address.port), timeout=CONNECT_SECONDS)
            with contextlib.closing(paramiko.Transport(connected)) as transport:
                transport.banner_timeout = transport.handshake_timeout = transport.auth_timeout = STEP_SECONDS
                transport.start_client(timeout=STEP_SECONDS)
                if _try_password(transport, other.layout.user, other.password) is None:
                    raise RefusedError(
                        f"this robot has a {other.name}, but the robots of season {CURRENT.year} have a "
                        f"{controller.name}",
                        where=str(address),
                        remedy="Choose another robot with --team or --robot, or deploy with the WPILib of the season "
                        f"that has a {other.name}.",
                    )


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
            remedy = "At a terminal, you are asked for it. Or offer a key of yours: --identity FILE, or --ssh-agent."
            if credentials.ask_password is not None:
                what = f"the robot refuses {user} with this password, and with the default one"
                remedy = f"Type the password that {user} has on the robot, or image the robot again."
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
