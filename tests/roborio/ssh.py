"""A plain SSH connection to a look-alike, for tests of its traffic."""

from __future__ import annotations

import socket
from types import TracebackType
from typing import TYPE_CHECKING

from pyfrc_core.deploy.errors import ConnectionFailedError
from pyfrc_core.deploy.targets import ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO

from .machine import PATIENCE

if TYPE_CHECKING:
    import paramiko


class SshConnection:
    """A connection until the end of the ``with`` block. Host keys are not checked."""

    def __init__(self, host: str, port: int, user: str | None = None, controller: ControllerKind = ROBORIO) -> None:
        import paramiko

        self.address = f"{host}:{port}"
        self.controller = controller
        self.transport: paramiko.Transport | None = None
        try:
            self.transport = paramiko.Transport(socket.create_connection((host, port), timeout=PATIENCE))
            self.transport.banner_timeout = PATIENCE
            self.transport.connect(username=user or controller.layout.user, password=controller.password)
        except (OSError, EOFError, paramiko.SSHException) as error:
            self.close()
            raise ConnectionFailedError(f"no connection: {error}") from error

    def __enter__(self) -> SshConnection:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Hang up."""
        if self.transport is not None:
            self.transport.close()

    def open(self, command: str) -> paramiko.Channel:
        """Run a command."""
        import paramiko

        assert self.transport is not None
        try:
            channel = self.transport.open_session(timeout=PATIENCE)
            channel.settimeout(PATIENCE)
            channel.exec_command(command)
        except (OSError, EOFError, paramiko.SSHException) as error:
            raise ConnectionFailedError(f"no channel: {error}") from error
        return channel

    def run(self, command: str) -> str:
        """What a command prints."""
        channel = self.open(command)
        channel.set_combine_stderr(True)
        return channel.makefile().read().decode()
