"""Processes of a Dask cluster that start warm: forked from one that has imported Dask, and what its workers import.

A scheduler, each worker, each process that plays a worker's matches and each campaign would take a second of processor
time for imports alone.
"""

from __future__ import annotations

import functools
import os
import socket
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any, NamedTuple

import warm_processes
import warm_start
from started_commands import How, StartedCommand, StartWarm, start_command, start_process

from pyfrc_core.processes import spawn

_IMPORTED = (
    "dask.cli",
    "distributed.cli.dask_scheduler",
    "distributed.cli.dask_worker",
    "pyfrc_core.fuzz.campaign.cluster_worker",
    "pyfrc_core.fuzz.campaign.campaign",
    "pyfrc_core.fuzz.campaign.executors",
    "pyfrc_cli.main",
    "pyfrc_cli.fuzz",
    "numpy.random",  # each match seeds it, since Dask has imported numpy
)


class Starts:
    """Starts programs; without warm starts, in new interpreters.

    :param environment: that of programs with which nothing is special
    """

    def __init__(self, environment: Mapping[str, str]) -> None:
        self._environment = dict(environment)
        self._warm: StartWarm | None = None
        if warm_start.POSSIBLE:
            address = warm_processes.WarmProcesses(environment, __file__).address
            self._warm = functools.partial(warm_processes.ask_for_command, address, address)

    def start(
        self, program: str, arguments: list[str], directory: Path, env: Mapping[str, str] | None = None
    ) -> StartedCommand:
        """Start ``python -m program arguments``, without input.

        :param env: variables, besides those that all programs have
        """
        environment = {**self._environment, **(env or {})}
        return start_command(
            lambda streams: start_process(self._warm, program, arguments, How(directory, environment, streams)),
            apart=True,
        )


class _Player(NamedTuple):
    """A process that plays a worker's matches; with what `RequestProcess` uses of `subprocess.Popen`."""

    process: warm_processes.WarmProcess
    stdin: IO[bytes]
    stdout: IO[bytes]

    @property
    def pid(self) -> int:
        return self.process.pid

    def wait(self) -> int:
        return self.process.wait()

    def kill(self) -> None:
        self.process.kill()


def _open_interpreter(address: str, cold: Any, how: spawn.Start) -> Any:
    """Do what `spawn.open_interpreter` does for the processes of a worker."""
    (their_in, to_it), (out, their_out) = os.pipe(), os.pipe()
    with Path(os.devnull).open("wb") as unread:
        environment = {**os.environ, **(how.environment or {})}
        warm = warm_processes.ask(address, ["call", sys.path, environment, []], [their_in, their_out, unread.fileno()])
    for descriptor in (their_in, their_out):
        os.close(descriptor)
    player = (os.fdopen(to_it, "wb"), os.fdopen(out, "rb"))
    if warm is None:
        for file in player:
            file.close()
        return cold(how)
    player[0].write(how.job())
    player[0].flush()
    return _Player(warm, *player)


def main() -> None:
    """The process that forks."""
    with socket.socket(fileno=os.dup(int(sys.argv[1]))) as listener:
        address = listener.getsockname().decode()
    spawn.open_interpreter = functools.partial(_open_interpreter, address, spawn.open_interpreter)
    warm_processes.main(*_IMPORTED)


if __name__ == "__main__":
    main()
