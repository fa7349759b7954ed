"""Showing the program's output where a command on the robot prints it, over SSH. `console` is for the other robots."""

from __future__ import annotations

import contextlib
import shlex
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager

from ..terminal_text import VisibleStream, one_line
from .connection import Connection
from .console import ConnectionReports
from .errors import ConnectionFailedError, NoConsoleError

_SECONDS_BETWEEN_TRIES = 1.0
#: A longer line is broken.
_MAX_LINE_BYTES = 1 << 16
_WAKE_SECONDS = 0.5  # on Windows, Ctrl-C does not interrupt a blocking receive


def follow_output(connect: Callable[[], AbstractContextManager[Connection]], quiet: bool = False) -> None:
    """Show the robot program's output until Ctrl-C. Reconnect after a lost connection.

    :param connect: connects to the robot
    :param quiet: do not report the state of the connection
    :raises NoConsoleError: if the robot cannot print it
    :raises DeployError: if the robot refuses the login
    """
    output, report = VisibleStream(sys.stdout), ConnectionReports(quiet)
    with contextlib.suppress(KeyboardInterrupt):
        while True:
            try:
                with connect() as connection:
                    report.reset()
                    report("connected", f"connected to {connection.address}")
                    for text in _texts(connection):
                        output.write(text)
                        output.flush()
                report("lost", f"the connection was lost; reconnecting to {connection.address}")
            except ConnectionFailedError as error:
                report("unreachable", f"{error.where}: {error.message}")
            time.sleep(_SECONDS_BETWEEN_TRIES)


def _texts(connection: Connection) -> Iterator[str]:
    """Yield the output of the robot's command until the connection is lost.

    :raises NoConsoleError: if the command ends by itself
    """
    with connection.opened(shlex.join(connection.controller.layout.output)) as channel:
        channel.settimeout(_WAKE_SECONDS)
        unfinished = b""
        while True:
            try:
                piece = channel.recv(1 << 16)
            except TimeoutError:
                continue
            if not piece:
                break
            lines, newline, unfinished = (unfinished + piece).rpartition(b"\n")
            if len(unfinished) > _MAX_LINE_BYTES:
                lines, newline, unfinished = lines + newline + unfinished, b"\n", b""
            yield (lines + newline).decode(errors="replace")
        if channel.exit_status_ready() and (status := channel.recv_exit_status()) > 0:
            said = channel.recv_stderr(4096).decode(errors="replace").strip()
            raise NoConsoleError(
                f"the program's output cannot be read: {one_line(said) or f'exit code {status}'}",
                where=str(connection.address),
                remedy="Perhaps the robot's image is too old.",
            )
