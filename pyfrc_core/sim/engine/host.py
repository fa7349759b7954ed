"""Makes robots' processes: one that has imported everything, and has none of WPILib's threads, forks them.

`main` runs in a new interpreter. It listens to the `Simulation` over a connection and ends with it. Where processes
cannot be forked, it becomes the first robot's process itself.
"""

from __future__ import annotations

import importlib
import os
import pickle
import shutil
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Client, wait
from pathlib import Path
from typing import Any, NoReturn

from ...processes.channel import Connection, close_in_forks, end_of_output
from ...processes.crash_report import CrashLog
from ...processes.exit import exit_by_signal, prepare_sudden_exit
from ...processes.worker import work_and_exit
from .commands import Quit

_LOOK_SECONDS = 0.2
#: Wall seconds in which a robot's process may complete its data logs. Only a robot that is stuck in C++ uses them up.
CLOSING_SECONDS = 10.0

#: Libraries that are known to start no threads when they are imported.
_HARMLESS = {
    "commands2", "hal", "magicbot", "native", "navx", "ntcore", "numpy", "pathplannerlib", "phoenix6", "photonlibpy",
    "pint", "pydantic", "pyfrc", "pyfrc_core", "rev", "wpilib", "wpimath", "wpinet", "wpiutil",
}  # fmt: skip


@dataclass(frozen=True)
class Hosting:
    """What a host is started with.

    :param address: where the simulation listens; likewise `key`
    :param fork: whether to fork robots' processes
    :param temporary: the simulation's directory, to tidy away when it has been killed itself
    :param name: by which it introduces itself: the connection of a host that was ended may be accepted late
    :param stamp: what says when something was printed; see `OutputPipe`
    """

    address: Any
    key: bytes
    fork: bool
    temporary: str
    name: str = "host"
    stamp: str = ""


@dataclass(frozen=True)
class Launch:
    """Have a robot's process made.

    :param number: by which the process introduces itself
    :param job: the pickled `Job`
    :param crash_log: the file that its `CrashLog` writes to
    """

    number: int
    job: bytes
    crash_log: Path


@dataclass(frozen=True)
class Kill:
    """End the robot's process."""


@dataclass(frozen=True)
class Preload:
    """Import these modules for the robots to come."""

    modules: Sequence[str]


@dataclass(frozen=True)
class Exited:
    """A robot's process has ended."""

    number: int
    status: int


def main(hosting: Hosting) -> None:
    """The process."""
    connection = _connect(hosting, hosting.name)
    if connection is None:
        shutil.rmtree(hosting.temporary, ignore_errors=True)
        return
    # Ends with the simulation, and not by Ctrl-C in its terminal.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    from .robot_side import robot_process  # noqa: F401 - what every robot needs, imported before it is needed

    if hosting.fork:
        _Forks(hosting, connection).serve()
    else:
        with suppress(EOFError):
            while isinstance(command := connection.recv(), Preload):
                _preload(command.modules)
            _become_the_robot(hosting, command)


def _connect(hosting: Hosting, who: str | int) -> Connection | None:
    """Connect to the simulation; return None if it was closed or killed meanwhile.

    :param who: the host's name, or the number of a robot's launch
    """
    with suppress(OSError, EOFError):
        connection = Client(hosting.address, authkey=hosting.key)
        connection.send(who)
        return connection
    return None


class _Forks:
    """The robots' processes, one at a time."""

    def __init__(self, hosting: Hosting, connection: Connection) -> None:
        self._hosting = hosting
        self._connection = connection
        self._fork: Any = None
        self._number = 0

    def serve(self) -> None:
        """Do what the simulation says until it is gone."""
        from ...processes.fork import Fork

        while True:
            if self._fork is None:
                there = wait([self._connection])
            else:  # what a robot has started may outlive it, and hold its pipe open
                there = wait([self._connection, self._fork.fileno()], _LOOK_SECONDS)
            if self._fork is not None:
                self._fork.poll()
                if self._fork.finished:
                    self._gone()
            if self._connection not in there:
                continue
            try:
                command = self._connection.recv()
            except (EOFError, ConnectionError):
                self._kill()
                shutil.rmtree(self._hosting.temporary, ignore_errors=True)
                return
            if isinstance(command, Quit):
                self._kill()
                return
            if isinstance(command, Preload):
                _preload(command.modules)
                continue
            self._kill()
            if isinstance(command, Launch):
                self._number = command.number
                self._fork = Fork(partial(self._become_the_robot, command))

    def _kill(self) -> None:
        if self._fork is not None:
            self._fork.terminate(CLOSING_SECONDS)
            self._gone()

    def _gone(self) -> None:
        status, self._fork = self._fork.status, None
        with suppress(OSError):
            self._connection.send(Exited(self._number, status))

    def _become_the_robot(self, launch: Launch, send: object) -> None:
        self._connection.close()
        _become_the_robot(self._hosting, launch)


def _preload(modules: Sequence[str]) -> None:
    for name in modules:
        if name.partition(".")[0] in _HARMLESS and name not in sys.modules:
            with suppress(Exception):  # the robot's own import fails, too
                importlib.import_module(name)


def _ending_the_robot() -> Callable[[int, object], None]:
    """Return a signal handler that completes the robot's data logs and ends this process, wherever its code is."""
    robot = os.getpid()

    def end(signum: int, frame: object) -> None:
        if os.getpid() != robot:  # robot code has forked this one, which ends as if there were no handler
            signal.signal(signum, signal.SIG_DFL)
            os.kill(os.getpid(), signum)
            return
        exit_by_signal(signum, frame, prepare_sudden_exit)

    return end


def _become_the_robot(hosting: Hosting, launch: Launch) -> NoReturn:
    with launch.crash_log.open("w+b", buffering=0) as file:
        work_and_exit(partial(_run_robot, hosting, launch), file.fileno())


def _run_robot(hosting: Hosting, launch: Launch, log: CrashLog) -> None:
    from .robot_side.robot_process import run_robot

    signal.signal(signal.SIGTERM, _ending_the_robot())
    connection = _connect(hosting, launch.number)
    if connection is None:
        return
    close_in_forks(connection)
    run_robot(pickle.loads(launch.job), connection, log, hosting.stamp)
    end_of_output(connection)
