"""What pyfrc uses of paramiko without its promise: what has changed when one of these fails, the message says."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import paramiko
import pytest

from pyfrc_core.compat import paramiko_private
from pyfrc_core.compat.private_name import IncompatibleLibraryError, PrivateName
from pyfrc_core.deploy.connection import GreetedSocket


@pytest.mark.parametrize("name", paramiko_private.NAMES, ids=lambda name: name.path)
def test_it_is_there(name: PrivateName) -> None:
    try:
        name.find()
    except IncompatibleLibraryError:
        pytest.fail(name.gone)


class Logins(paramiko.ServerInterface):
    def __init__(self, lets_in: bool) -> None:
        self._lets_in = lets_in

    def get_allowed_auths(self, username: str) -> str:
        return "publickey"

    def check_auth_none(self, username: str) -> int:
        return paramiko.AUTH_SUCCESSFUL if self._lets_in and username == "lvuser" else paramiko.AUTH_FAILED


@contextmanager
def greeted(lets_in: bool) -> Iterator[paramiko.Transport]:
    """A transport whose key exchange is over, over a socket to which the greeting was sent before."""
    ours, theirs = socket.socketpair()
    greeting = GreetedSocket(ours, "SSH-2.0-pyfrc_test")
    server = paramiko.Transport(theirs)
    server.add_server_key(paramiko.ECDSAKey.generate())
    server.start_server(event=threading.Event(), server=Logins(lets_in))
    transport = paramiko.Transport(greeting)
    transport.local_version = "SSH-2.0-pyfrc_test"
    try:
        transport.start_client(timeout=10)
        assert server.remote_version == "SSH-2.0-pyfrc_test"
        yield transport
    finally:
        transport.close()
        server.close()


def test_a_login_without_waiting_for_the_service() -> None:
    with greeted(lets_in=True) as transport:
        paramiko_private.log_in_as(transport, "lvuser")
        assert transport.is_authenticated()
        assert transport.get_username() == "lvuser"


def test_a_paramiko_without_these_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(paramiko_private, "NAMES", [PrivateName("paramiko:Transport._gone", "nothing")])
    with greeted(lets_in=True) as transport:
        paramiko_private.log_in_as(transport, "lvuser")
        assert transport.is_authenticated()


def test_a_refused_login_names_what_is_allowed() -> None:
    with greeted(lets_in=False) as transport:
        with pytest.raises(paramiko.BadAuthenticationType) as refused:
            paramiko_private.log_in_as(transport, "lvuser")
        assert refused.value.allowed_types == ["publickey"]
        assert not transport.is_authenticated()
