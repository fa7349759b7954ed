"""Logging in to the robot: with the default password, or with a password that is typed."""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Callable
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Credentials:
    """The password to offer, if it is not the default one.

    :param ask_password: asks the user for the password of a robot that is named, once for each robot; None if the user
        cannot be asked
    """

    ask_password: Callable[[str], str] | None = None


NONE_OFFERED = Credentials()


def log_in(
    transport: paramiko.Transport,
    address: Address,
    controller: ControllerKind,
    user: str,
    credentials: Credentials,
    key: HostKey,
) -> None:
    """Log in with the default password, or with a password for which the user is asked.

    :param key: the robot's, which the question names
    :raises ConnectionFailedError: if the robot refuses all of them
    :raises RefusedError: if it has another controller
    """
    import paramiko

    allowed = _try_password(transport, user, controller.password)
    if allowed is None:
        return
    _refuse_other_controller(address, controller)  # before a question that cannot help
    if "password" in allowed and controller.password and credentials.ask_password is not None:
        with contextlib.suppress(paramiko.AuthenticationException):
            password = credentials.ask_password(f"{user}@{address} (its key: {key.fingerprint})")
            transport.auth_password(user, password, fallback=False)
        if transport.is_authenticated():
            return
    raise _refused(address, controller, user, allowed, credentials)


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
    address: Address, controller: ControllerKind, user: str, allowed: list[str], credentials: Credentials
) -> ConnectionFailedError:
    if "password" in allowed:
        if controller.password:
            what = f"the robot refuses {user} with the password {controller.password}, which is the default on robots"
            remedy = "At a terminal, you are asked for it."
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
        what = f"the robot does not let {user} in with a password, and pyfrc logs in only with one"
        remedy = "Allow passwords in the settings of its SSH server, or image the robot again."
    return ConnectionFailedError(what, where=str(address), remedy=remedy)
