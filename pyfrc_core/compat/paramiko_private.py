"""What pyfrc uses of paramiko although paramiko may change it: a login without a password that saves a round trip.

`deploy.connection` imports this module, which imports paramiko, when it logs in. With a version of paramiko that lacks
one of these names, the login waits for one response more. tests/test_compat_paramiko.py tests this module.
"""

from __future__ import annotations

import threading

import paramiko
from paramiko.auth_handler import AuthHandler
from paramiko.common import cMSG_USERAUTH_REQUEST

from .private_name import IncompatibleLibraryError, PrivateName

_SAVES = "the login sends its request beside the one for the service, which saves a round trip"
NAMES = (
    PrivateName("paramiko.auth_handler:AuthHandler._request_auth", _SAVES),
    PrivateName("paramiko.auth_handler:AuthHandler._parse_service_accept", _SAVES),
    PrivateName("paramiko:Transport._send_message", _SAVES),
)


class _ImmediateLogin(AuthHandler):
    """Sends the login request immediately after the request for the service, without waiting for its response."""

    def _request_auth(self) -> None:
        super()._request_auth()  # type: ignore[misc]
        message = paramiko.Message()
        message.add_byte(cMSG_USERAUTH_REQUEST)
        for text in (self.username or "", "ssh-connection", "none"):
            message.add_string(text)
        self.transport._send_message(message)  # type: ignore[attr-defined]

    def _parse_service_accept(self, message: paramiko.Message) -> None:
        """Do nothing: the login request was already sent."""


def log_in_as(transport: paramiko.Transport, user: str) -> None:
    """Log in without a password, as `paramiko.Transport.auth_none` does.

    :raises paramiko.SSHException: if the login fails
    """
    try:
        for name in NAMES:
            name.find()
    except IncompatibleLibraryError:
        transport.auth_none(user)
        return
    event = threading.Event()
    transport.auth_handler = handler = _ImmediateLogin(transport)
    handler.auth_none(user, event)
    handler.wait_for_response(event)
