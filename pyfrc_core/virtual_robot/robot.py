"""A virtual robot: its disk, program, console and SSH server."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

from ..deploy.agent.virtual import VARIABLE, VirtualRobotClient
from ..deploy.targets import controller_of
from ..errors import PyfrcError
from ..season import CURRENT
from ..terminal_text import visible
from .console import ConsoleServer
from .control import Control
from .disk import RobotDisk
from .supervisor import Supervisor

HOST = "127.0.0.1"
#: The first default port, and the number of ports to try.
FIRST_PORT = 2222
_PORTS = 100


def default_directory() -> Path:
    """Return the default directory for a virtual robot's files, in the user's data directory."""
    import platformdirs

    return platformdirs.user_data_path("pyfrc", appauthor=False) / "virtual-robot"


class VirtualRobot:
    """A virtual robot that runs until the end of the ``with`` block.

    :param directory: where it stores its files
    :param port:      the port of its SSH server; default: the port of the last start, else the first free one from
        `FIRST_PORT` on
    :param fresh:     start without programs
    :param on_line:   called in a separate thread with each line of its program's output
    :param on_end:    called in a separate thread with the reason for the end of its program
    :raises PyfrcError: if the port is not free, or another virtual robot uses the directory
    """

    def __init__(
        self,
        directory: Path,
        *,
        port: int | None = None,
        fresh: bool = False,
        on_line: Callable[[str], object] = lambda line: None,
        on_end: Callable[[str], object] = lambda what: None,
    ) -> None:
        from .ssh_server import SshServer

        with ExitStack() as stack:
            layout = controller_of(CURRENT).layout
            disk = stack.enter_context(RobotDisk(directory, layout, fresh))
            listening = stack.enter_context(_listener(port, disk.last_port()))
            self.directory = directory
            self.port: int = listening.getsockname()[1]
            console = ConsoleServer(HOST)
            stack.callback(console.close)

            def printed(line: bytes) -> None:
                console.send(line)
                on_line(visible(line.decode(errors="replace")))

            supervisor = Supervisor(disk.paths, printed, on_end)
            control = Control(supervisor)
            stack.callback(control.close)
            client = VirtualRobotClient(layout, str(disk.paths.root), control.port, control.key, console.port)
            environment = {**os.environ, VARIABLE: client.to_text()}
            server = SshServer(listening, disk.key, console.port, disk.paths, environment)
            supervisor.start()
            stack.callback(supervisor.close)
            stack.callback(server.close)
            disk.write_address(self.address, self.port)
            self._stack = stack.pop_all()

    @property
    def address(self) -> str:
        """The address for ``pyfrc deploy --robot``."""
        return f"{HOST}:{self.port}"

    def __enter__(self) -> VirtualRobot:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._stack.close()


def _listener(port: int | None, last: int | None) -> socket.socket:
    """Listen at the given port, else at the port of the last start, for which projects have pinned its key."""
    ports = [port] if port is not None else [last, *range(FIRST_PORT, FIRST_PORT + _PORTS)]
    for each in ports:
        if each is not None:
            try:
                return socket.create_server((HOST, each))
            except (OSError, OverflowError) as error:
                failure = error
    number = failure.errno if isinstance(failure, OSError) else None
    raise PyfrcError(
        f"the port cannot be used: {os.strerror(number or 0)}",
        where=f"{HOST}:{port if port is not None else FIRST_PORT}",
        remedy="Another program may use it. Choose another port with --port N, or leave out --port.",
    )
