"""A virtual robot: its disk, program, console and SSH server.

Deploy agents stop and start its program through a server. For the command line, it runs until Ctrl-C, or as long as
another command.
"""

from __future__ import annotations

import json
import os
import secrets
import shutil
import socket
import socketserver
import subprocess
import threading
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from ..deploy.agent.virtual import VARIABLE, VirtualRobotClient
from ..deploy.targets import CONTROLLERS, ControllerKind, controller_of
from ..errors import PyfrcError, UsageError
from ..season import CURRENT
from ..terminal_text import visible
from .console import ConsoleServer
from .disk import RobotDisk
from .supervisor import Supervisor

#: Seconds after which a client that sends or reads nothing is disconnected, and the longest request in bytes.
_LIMIT_SECONDS = 10.0
_LIMIT_BYTES = 200


class Control(socketserver.ThreadingTCPServer):
    """The server, in threads of its own until `close`.

    A request is one line: the key, a space, and what to do. The response is the list of the program's processes, as
    JSON.

    :param supervisor: starts and stops the program
    """

    daemon_threads = True
    block_on_close = False
    request_queue_size = 16  # agents of several laptops may connect at the same time

    def __init__(self, supervisor: Supervisor) -> None:
        super().__init__(("127.0.0.1", 0), _Request)
        self.supervisor = supervisor
        #: The authentication key for agents, in hexadecimal.
        self.key = secrets.token_hex(32)
        self.port = int(self.socket.getsockname()[1])
        threading.Thread(target=self.serve_forever, name="virtual robot: control", daemon=True).start()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing: a client has disconnected, or was too slow."""

    def close(self) -> None:
        """Stop the server."""
        self.shutdown()
        self.server_close()


class _Request(socketserver.StreamRequestHandler):
    timeout = _LIMIT_SECONDS
    server: Control

    def handle(self) -> None:
        key, _, request = self.rfile.readline(_LIMIT_BYTES).strip().partition(b" ")
        if not secrets.compare_digest(key, self.server.key.encode()):
            return
        supervisor = self.server.supervisor
        if request == b"stop":
            supervisor.stop()
        elif request == b"restart":
            supervisor.restart()
        self.wfile.write(json.dumps(supervisor.processes()).encode())


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
    :param controller: the controller that it stands for; default: the season's
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
        controller: ControllerKind | None = None,
        port: int | None = None,
        fresh: bool = False,
        on_line: Callable[[str], object] = lambda line: None,
        on_end: Callable[[str], object] = lambda what: None,
    ) -> None:
        from .ssh_server import SshServer

        with ExitStack() as stack:
            controller = controller or controller_of(CURRENT)
            layout = controller.layout
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
            server = SshServer(listening, disk.key, console.port, disk.paths, controller.password, environment)
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


#: Seconds between two checks for Ctrl-C, which does not interrupt a wait without time limit on Windows.
_CHECK_SECONDS = 0.5


def show(
    directory: Path | None,
    controller: str | None,
    port: int | None,
    fresh: bool,
    on_line: Callable[[str], object],
    on_news: Callable[[str], object],
) -> None:
    """Run a virtual robot until Ctrl-C or SIGTERM.

    :param controller: the name of the controller that it stands for; default: the season's
    :param on_line: called with each line of its program's output
    :param on_news: called with other messages
    :raises PyfrcError: if it cannot be started
    """
    directory, kind = (directory or default_directory()).absolute(), _controller(controller)
    with (
        suppress(KeyboardInterrupt),
        VirtualRobot(
            directory,
            controller=kind,
            port=port,
            fresh=fresh,
            on_line=on_line,
            on_end=lambda text: on_news(f"-- {text}"),
        ) as robot,
    ):
        on_news(f"A virtual robot is running at {robot.address}; its files are in {directory}")
        on_news(f"Deploy to it, in a robot project: pyfrc deploy --robot {robot.address}")
        on_news("The output of its program follows. Ctrl-C stops the robot; its programs are kept.")
        while True:
            threading.Event().wait(_CHECK_SECONDS)


def _controller(name: str | None) -> ControllerKind | None:
    """Return the controller with this name, in upper or lower case.

    :raises UsageError: if there is none
    """
    if name is None:
        return None
    found = next((each for each in CONTROLLERS if each.name.lower() == name.lower()), None)
    if found is None:
        names = " or ".join(each.name.lower() for each in CONTROLLERS)
        raise UsageError(f"there is no controller {name!r}", remedy=f"Write: --controller {names}")
    return found


def run_command(
    command: Sequence[str], directory: Path | None, controller: str | None, port: int | None, fresh: bool
) -> int:
    """Run a command with a virtual robot's address as last argument, and stop the robot when it has ended.

    :return: the command's exit code; 128 + N if signal N has ended it, as in a shell
    :raises PyfrcError: if the robot or the command cannot be started
    """
    program = shutil.which(command[0])
    if program is None:
        raise UsageError(f"there is no command {command[0]!r}", remedy="Write: pyfrc virtual-robot -- COMMAND")
    directory, kind = (directory or default_directory()).absolute(), _controller(controller)
    with VirtualRobot(directory, controller=kind, port=port, fresh=fresh) as robot:
        code = subprocess.run([program, *command[1:], robot.address], check=False).returncode
    return code if code >= 0 else 128 - code
