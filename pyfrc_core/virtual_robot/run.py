"""A virtual robot for the command line: it runs until Ctrl-C, or as long as another command."""

from __future__ import annotations

import shutil
import subprocess
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from ..errors import UsageError
from ..interruption import ending_like_ctrl_c
from .robot import VirtualRobot, default_directory

#: Seconds between two checks for Ctrl-C, which does not interrupt a wait without time limit on Windows.
_CHECK_SECONDS = 0.5


def show(
    directory: Path | None,
    port: int | None,
    fresh: bool,
    on_line: Callable[[str], object],
    on_news: Callable[[str], object],
) -> None:
    """Run a virtual robot until Ctrl-C or SIGTERM.

    :param on_line: called with each line of its program's output
    :param on_news: called with other messages
    :raises PyfrcError: if it cannot be started
    """
    directory = (directory or default_directory()).absolute()
    with (
        suppress(KeyboardInterrupt),
        ending_like_ctrl_c(),
        VirtualRobot(
            directory, port=port, fresh=fresh, on_line=on_line, on_end=lambda text: on_news(f"-- {text}")
        ) as robot,
    ):
        on_news(f"A virtual robot is running at {robot.address}; its files are in {directory}")
        on_news(f"Deploy to it, in a robot project: pyfrc deploy --robot {robot.address}")
        on_news("The output of its program follows. Ctrl-C stops the robot; its programs are kept.")
        while True:
            threading.Event().wait(_CHECK_SECONDS)


def run_command(command: Sequence[str], directory: Path | None, port: int | None, fresh: bool) -> int:
    """Run a command with a virtual robot's address as last argument, and stop the robot when it has ended.

    :return: the command's exit code; 128 + N if signal N has ended it, as in a shell
    :raises PyfrcError: if the robot or the command cannot be started
    """
    program = shutil.which(command[0])
    if program is None:
        raise UsageError(f"there is no command {command[0]!r}", remedy="Write: pyfrc virtual-robot -- COMMAND")
    directory = (directory or default_directory()).absolute()
    with ending_like_ctrl_c(), VirtualRobot(directory, port=port, fresh=fresh) as robot:
        code = subprocess.run([program, *command[1:], robot.address], check=False).returncode
    return code if code >= 0 else 128 - code
