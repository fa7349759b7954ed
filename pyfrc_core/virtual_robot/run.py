"""A virtual robot for the command line: shown until Ctrl-C, or for as long as another command runs."""

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

#: Seconds between two looks for Ctrl-C, which interrupts no endless wait on Windows.
_TURN = 0.5


def show(
    directory: Path | None,
    port: int | None,
    fresh: bool,
    on_line: Callable[[str], object],
    on_news: Callable[[str], object],
) -> None:
    """Keep a virtual robot switched on until Ctrl-C, or a signal that ends a process.

    :param on_line: called with each line that its program prints
    :param on_news: called with what else there is to say
    :raises PyfrcError: when it cannot be started
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
        on_news("What its program prints follows. Ctrl-C ends it; its programs are kept.")
        while True:
            threading.Event().wait(_TURN)


def run_command(command: Sequence[str], directory: Path | None, port: int | None, fresh: bool) -> int:
    """Run a command with a virtual robot's address as last argument; the robot ends with it.

    :return: the command's exit code
    :raises PyfrcError: when the robot or the command cannot be started
    """
    program = shutil.which(command[0])
    if program is None:
        raise UsageError(f"there is no command {command[0]!r}", remedy="Write: pyfrc virtual-robot -- COMMAND")
    directory = (directory or default_directory()).absolute()
    with ending_like_ctrl_c(), VirtualRobot(directory, port=port, fresh=fresh) as robot:
        return subprocess.run([program, *command[1:], robot.address], check=False).returncode
