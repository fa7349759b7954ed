"""A virtual robot as the host of the agent.

The virtual robot describes itself in an environment variable of the agent's process. A laptop cannot set this variable,
and it does not exist on a real robot.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable

from .console import Console, ConsoleClient
from .layout import Layout
from .release_record import Boot
from .robot_paths import RobotPaths

VARIABLE = "PYFRC_VIRTUAL_ROBOT"


class VirtualRobotClient:
    """The virtual robot that runs this agent.

    :param layout:  the controller that it stands for
    :param root:    the directory with its files
    :param control: the loopback port of its supervisor
    :param key:     the supervisor's authentication key, in hexadecimal
    :param console: the loopback port of its console
    """

    is_virtual = True

    def __init__(self, layout: Layout, root: str, control: int, key: str, console: int) -> None:
        self.paths = RobotPaths(layout, root)
        self.control = control
        self.key = key
        self.console_port = console

    @classmethod
    def from_environment(cls, layout: Layout) -> VirtualRobotClient | None:
        """Return the virtual robot that runs this agent, or None on a real robot."""
        text = os.environ.get(VARIABLE)
        return None if text is None else cls(layout, **json.loads(text))

    def to_text(self) -> str:
        """Return the value of the environment variable."""
        root = str(self.paths.root)
        return json.dumps({"root": root, "control": self.control, "key": self.key, "console": self.console_port})

    def console(self) -> Console:
        """Return a client for the program's output."""
        return ConsoleClient("127.0.0.1", (self.console_port,))

    def can_restart(self) -> bool:
        """Return whether the program can be stopped and started."""
        return True

    def processes(self) -> set[int]:
        """Return the process ids of the robot program."""
        return set(self._request("processes"))

    def is_running(self, process: int) -> bool:
        """Return whether a process of the program still runs."""
        return process in self.processes()

    def boot(self) -> Boot:
        """Return its last start."""
        return Boot(hashlib.sha256(self.key.encode()).hexdigest())

    def serves_network_tables(self, process: int) -> bool | None:
        """Return None: each virtual robot on a computer has another port."""
        return None

    def stop(self, start: bool, meanwhile: Callable[[], None] = lambda: None) -> bool:
        """Stop the program, and start the current one if wanted. Return when the old one has ended.

        :return: False, since the program always ends
        """
        self._request("restart" if start else "stop")
        return False

    def _request(self, name: str) -> list[int]:
        import socket  # not before, since a real robot does not need it

        with socket.create_connection(("127.0.0.1", self.control)) as connection:
            connection.sendall(f"{self.key} {name}\n".encode())
            with connection.makefile(encoding="utf-8") as response:
                return list(json.load(response))
