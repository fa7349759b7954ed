"""When the key of a robot is pinned, and when it is compared."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import paramiko
import pytest

from pyfrc_core.deploy.connection import connect
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import ConnectionFailedError, HostKeyError
from pyfrc_core.deploy.host_keys import HostKey, HostKeys
from pyfrc_core.deploy.targets.roborio import ROBORIO

SERVER_KEY = paramiko.ECDSAKey.generate()
SHOWN = HostKey(SERVER_KEY.get_name(), SERVER_KEY.asbytes())


class Logins(paramiko.ServerInterface):
    """Lets users in, or refuses all of them."""

    def __init__(self, lets_in: bool) -> None:
        self._lets_in = lets_in

    def get_allowed_auths(self, username: str) -> str:
        return "password"

    def check_auth_none(self, username: str) -> int:
        return paramiko.AUTH_SUCCESSFUL if self._lets_in else paramiko.AUTH_FAILED


@contextmanager
def ssh_server(lets_in: bool) -> Iterator[tuple[Address, list[socket.socket]]]:
    """An SSH server for one connection: its address, as a robot's, and the connection to it."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        ours = socket.create_connection(listener.getsockname())
        theirs, _ = listener.accept()
    transport = paramiko.Transport(theirs)
    transport.add_server_key(SERVER_KEY)
    try:
        transport.start_server(event=threading.Event(), server=Logins(lets_in))
        yield Address("10.12.34.2"), [ours]
    finally:
        transport.close()
        ours.close()


@pytest.mark.parametrize("accepted", [None, SHOWN.fingerprint], ids=["first seen", "accepted"])
def test_a_key_is_pinned_only_after_the_login(accepted: str | None, tmp_path: Path) -> None:
    """A stranger's server at the team's address does not let us in, and must not become the team's robot."""
    if accepted:
        HostKeys(tmp_path).of_robot(Address("10.12.34.2"), ROBORIO).check(HostKey("ssh-ed25519", b"the robot's"))
    before = [str(known) for known in HostKeys(tmp_path).entries()]
    keys = HostKeys(tmp_path).of_robot(Address("10.12.34.2"), ROBORIO)
    with ssh_server(lets_in=False) as (address, [connected]), pytest.raises(ConnectionFailedError, match="refuses"):
        connect(address, ROBORIO, keys, connected=connected, accepted_key=accepted, robot_name="practice")
    assert [str(known) for known in HostKeys(tmp_path).entries()] == before
    with ssh_server(lets_in=True) as (address, [connected]):
        options = {"accepted_key": accepted, "robot_name": "practice"}
        with connect(address, ROBORIO, keys, connected=connected, **options) as connection:
            assert connection.recognized.new_for == "team 1234"
    after = [str(known) for known in HostKeys(tmp_path).entries()]
    assert after == [*before, f"{SHOWN.fingerprint} (practice)"]


def test_a_key_that_is_not_expected_is_refused_before_the_login(tmp_path: Path) -> None:
    keys = HostKeys(tmp_path).of_robot(Address("10.12.34.2"), ROBORIO)
    keys.check(HostKey("ssh-ed25519", b"the robot's"))
    with ssh_server(lets_in=False) as (address, [connected]), pytest.raises(HostKeyError):
        connect(address, ROBORIO, keys, connected=connected)
