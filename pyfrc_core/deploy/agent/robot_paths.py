"""Paths on the robot, the agent's exception, and the deploy lock."""

from __future__ import annotations

import json
import os
import re
import time
from contextlib import suppress
from io import FileIO
from pathlib import Path
from types import TracebackType
from typing import Any

from .disk import text_of
from .layout import Layout
from .system import lock

#: Seconds to wait for a lock: the agent of a deploy that was just interrupted may still hold it.
_GRACE = 2.0


class Refusal(Exception):
    """The request cannot be carried out.

    :param kind:   the error's name in the protocol: ``locked``, ``space``, ...
    :param remedy: what the user can do
    """

    def __init__(self, kind: str, message: str, remedy: str = "", **details: Any) -> None:
        super().__init__(message)
        self.kind = kind
        self.remedy = remedy
        self.details = details


class RobotPaths:
    """The robot's directories and files.

    :param root: the directory that contains all of them; ``/`` on a robot
    """

    def __init__(self, layout: Layout, root: str = "/") -> None:
        self.layout = layout
        self.root = Path(root)
        self.home = self.of(layout.home)
        #: The code that the robot starts: a link to a release, or a directory created by another tool.
        self.code = self.of(layout.code)
        self.own = self.home / ".pyfrc"
        self.releases = self.own / "releases"
        #: Where the next release is assembled.
        self.incoming = self.own / "incoming"
        #: The name of a file until it takes its place in a release, where it would be the program's.
        self.between = self.own / "between"
        self.lock = self.own / "lock"
        #: Where the robot finds the releases.
        self.releases_on_robot = f"{layout.home}/.pyfrc/releases"

    def of(self, path: str) -> Path:
        """Return where a path of the robot is in this file system."""
        return self.root / path.lstrip("/")

    def is_debug(self) -> bool:
        """Return whether the robot starts the program for debugging, on a controller with a file for this."""
        return bool(self.layout.debug_flag) and self.of(self.layout.debug_flag).exists()

    def start_command(self) -> str:
        """Return the command that the robot starts the program with; empty if there is none."""
        name = self.layout.debug_command if self.is_debug() else self.layout.command
        return text_of(self.home / name) or ""


def start_commands(layout: Layout, main: str, debug: bool, environment: str | None = None) -> dict[str, str | None]:
    """Return the content of the robot's start command files for a program with this main file.

    :param environment: the environment that it starts with; None: with the layout's Python
    :raises Refusal: if the main file's name has characters that are not allowed in a command
    """
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_./-]*", main):
        raise Refusal(
            "main",
            f"the main file cannot be called {main!r}: its name is part of the robot's start command",
            "Give it a name of letters, digits, '_', '-' and '.'.",
        )
    start, start_debug = (
        each.replace("{main}", f"{layout.code}/{main}") for each in (layout.start, layout.start_debug)
    )
    commands: dict[str, str | None] = {layout.command: start_debug if debug and not layout.debug_command else start}
    if layout.debug_command:
        commands[layout.debug_command] = start_debug
    return in_environment(layout, commands, environment)


def in_environment(layout: Layout, commands: dict[str, str | None], environment: str | None) -> dict[str, str | None]:
    """Return start commands with the Python of an environment; None: as they are."""
    if environment is None:
        return commands
    own = f"{layout.environments}/{environment}/bin/python3"
    return {name: text and text.replace(layout.python, own) for name, text in commands.items()}


class Lock:
    """The exclusive right to change the robot's programs. The system releases it when the process ends.

    :param wait: seconds to wait for another process to release it; by default, two
    """

    def __init__(self, paths: RobotPaths, who: str, wait: float | None = None) -> None:
        self._file = paths.lock
        self._who = who
        self._wait = _GRACE if wait is None else wait
        self._stream: FileIO | None = None

    def __enter__(self) -> None:
        give_up = time.monotonic() + self._wait
        while True:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            stream = self._file.open("a+b", buffering=0)
            try:
                lock(stream)
                if self._is_current(stream):
                    break
            except OSError:
                if time.monotonic() > give_up:
                    stream.seek(0)
                    holder = _holder(stream.read())
                    stream.close()
                    raise Refusal(
                        "locked",
                        f"{holder} is deploying to this robot right now",
                        "Wait until that is done; a laptop that is gone loses its turn after 20 seconds, or if its "
                        "program is starting, after a minute.",
                        holder=holder,
                    ) from None
            stream.close()
            time.sleep(0.02)
        self._stream = stream
        stream.truncate(0)
        with suppress(OSError):  # on a full disk, other computers do not learn who holds the lock
            stream.write(json.dumps({"who": self._who}).encode())

    def _is_current(self, stream: FileIO) -> bool:
        """Return whether this is still the lock file, and not one that an undeploy has removed meanwhile."""
        try:
            return os.path.samestat(os.fstat(stream.fileno()), self._file.stat())
        except FileNotFoundError:
            return False

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._stream is not None:
            self._stream.truncate(0)
            self._stream.close()


def _holder(text: bytes) -> str:
    try:
        return str(json.loads(text)["who"])
    except (ValueError, KeyError, TypeError):
        return "another computer"
