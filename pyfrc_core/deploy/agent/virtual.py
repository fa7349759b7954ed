"""A virtual robot, seen by the agent that runs on it: where its files are, and how its program is stopped and started.

The virtual robot describes itself in an environment variable of what it runs: no laptop can set it, and a roboRIO does
not have it.
"""

from __future__ import annotations

import json
import os
from functools import cache
from typing import Any

VARIABLE = "PYFRC_VIRTUAL_ROBOT"

Said = dict[str, Any]


class VirtualRobotClient:
    """The virtual robot that runs this agent.

    :param root:    the directory that holds its files
    :param control: the loopback port of its supervisor
    :param key:     which the supervisor asks for, in hexadecimal
    :param console: the loopback port of its console
    """

    def __init__(self, root: str, control: int, key: str, console: int) -> None:
        self.root = root
        self.control = control
        self.key = key
        self.console = console

    @classmethod
    def from_text(cls, text: str) -> VirtualRobotClient:
        """Read what `to_text` has written."""
        return cls(**json.loads(text))

    def to_text(self) -> str:
        """Return the value of the environment variable."""
        return json.dumps(vars(self))

    def processes(self) -> set[int]:
        """Return the processes of its robot program."""
        return set(self._ask("processes"))

    def stop(self) -> None:
        """Stop its program; return when it has ended."""
        self._ask("stop")

    def restart(self) -> None:
        """Stop its program and start what is current; return when the old one has ended."""
        self._ask("restart")

    def _ask(self, request: str) -> list[int]:
        # Imported here: a roboRIO does not need it.
        from multiprocessing.connection import Client

        with Client(("127.0.0.1", self.control), authkey=bytes.fromhex(self.key)) as connection:
            connection.send(request)
            return list(connection.recv())


@cache
def virtual_robot() -> VirtualRobotClient | None:
    """Return the virtual robot that runs this agent; none on a roboRIO."""
    text = os.environ.get(VARIABLE)
    return None if text is None else VirtualRobotClient.from_text(text)
