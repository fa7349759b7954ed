"""A virtual robot as a whole: its disk, its program, its console, its SSH server."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

from ..deploy.agent.virtual import VARIABLE, VirtualRobotClient
from ..errors import PyfrcError
from ..terminal_text import visible
from .console import Console
from .disk import RobotDisk
from .supervisor import Control, Supervisor

HOST = "127.0.0.1"
#: The first port that is tried where none is named, and how many.
FIRST_PORT = 2222
_PORTS = 100


def default_directory() -> Path:
    """Return where a virtual robot keeps its files when no directory is named: in the user's data directory."""
    import platformdirs

    return platformdirs.user_data_path("pyfrc", appauthor=False) / "virtual-robot"


class VirtualRobot:
    """A virtual robot that is switched on, until the end of the ``with`` block.

    :param directory: where its files are kept between starts
    :param port:      of its SSH server on this computer; none: that of the last start, else the first free one from
        `FIRST_PORT` on
    :param fresh:     begin without any program
    :param on_line:   called with each line that its program prints, from a thread
    :param on_end:    called with what has ended its program, from a thread
    :raises PyfrcError: when the port is taken, or another virtual robot runs in the directory
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
            disk = stack.enter_context(RobotDisk(directory, fresh))
            listening = stack.enter_context(_listener(port, disk.last_port()))
            self.directory = directory
            self.port: int = listening.getsockname()[1]
            console = Console(HOST)
            stack.callback(console.close)

            def printed(line: bytes) -> None:
                console.send(line)
                on_line(visible(line.decode(errors="replace")))

            supervisor = Supervisor(disk.places, printed, on_end)
            control = Control(supervisor)
            stack.callback(control.close)
            client = VirtualRobotClient(str(disk.places.root), control.port, control.key, console.port)
            environment = {**os.environ, VARIABLE: client.to_text()}
            server = SshServer(listening, disk.key, console.port, disk.places.home, environment)
            supervisor.start()
            stack.callback(supervisor.close)
            stack.callback(server.close)
            disk.write_address(self.address, self.port)
            self._stack = stack.pop_all()

    @property
    def address(self) -> str:
        """As ``pyfrc deploy --robot`` takes it."""
        return f"{HOST}:{self.port}"

    def __enter__(self) -> VirtualRobot:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._stack.close()


def _listener(port: int | None, last: int | None) -> socket.socket:
    """Listen at the port that is named; else at that of the last start, at which projects have pinned its key."""
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
        remedy="Another program may have it. Name another one with --port N, or leave --port out.",
    )
