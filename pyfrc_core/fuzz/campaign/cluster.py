"""Run matches on a Dask cluster: the part of a campaign on a cluster that runs on the computer with the project.

The scheduler distributes the matches, and gives those of a worker that is lost to another one. Results are used in the
order of the tasks, as those of local processes are, so that a campaign finds the same.
"""

from __future__ import annotations

import logging
import os
import pickle
import socket
import time
import uuid
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from typing import Any
from urllib.parse import urlsplit

from ..._version import requirement
from ...errors import PyfrcError, UsageError
from ...processes.call import run_in_subprocess
from ...project import Project
from ..match.work import MatchResult, NextWork, NoMoreWork, Result, Shrunk, Work
from .executors import WorkExecutor, all_lines
from .packed_project import pack

#: How long to try to reach the scheduler, and how long one that is there may take to respond: it may be busy.
_CONNECT_SECONDS, _RESPONSE_SECONDS = 10.0, 60.0
#: The interval of the checks for an interrupt.
_INTERRUPT_CHECK_SECONDS = 0.1
#: The time between two checks whether there are workers, and how long a campaign waits for the first new one.
_CHECK_SECONDS, _WITHOUT_WORKERS_SECONDS = 2.0, 60.0
#: How often the match of a process that has ended is played again.
_RETRIES = 2

#: The project's own files decide what a match does, and these variables.
_ENVIRONMENT = {"PYTHONHASHSEED": "0"}


class ClusterError(PyfrcError):
    """The cluster cannot play the matches, or no longer."""


@contextmanager
def open_cluster_executor(project: Project, address: str) -> Iterator[ClusterMatchExecutor]:
    """Open an executor that plays matches on a cluster.

    :param address: that of the scheduler, such as ``tcp://10.0.0.5:8786``
    :raises UsageError: when the package `distributed` is not installed, or the address is not valid
    :raises ClusterError: when the cluster cannot play matches
    """
    if find_spec("distributed") is None:
        raise UsageError(
            "--scheduler needs the package distributed, which is not installed",
            remedy=f'Install it with: pip install "{requirement("cluster")}"',
        )
    with _connected(address) as client:
        from .cluster_worker import ProjectOnWorker, versions

        _check_versions(client, address)
        name = f"pyfrc-{uuid.uuid4().hex}"
        environment = {key: os.environ.get(key, value) for key, value in _ENVIRONMENT.items()}
        client.register_plugin(ProjectOnWorker(pickle.dumps(pack(project)), environment, versions()), name)
        try:
            yield ClusterMatchExecutor(project, client, address, name)
        finally:
            if client.status == "running":
                with suppress(OSError, TimeoutError):  # the scheduler is lost, which the client has not noticed yet
                    client.unregister_worker_plugin(name)


class ClusterMatchExecutor(WorkExecutor):
    """Runs matches on a cluster.

    :param client: connected to the cluster
    :param address: that of the scheduler
    :param plugin: the name of the plugin that keeps the project on each worker
    """

    def __init__(self, project: Project, client: Any, address: str, plugin: str) -> None:
        super().__init__(project, max(1, sum(client.nthreads().values())))
        self._client = client
        self._address = address
        self._plugin = plugin
        self._executor: Executor = client.get_executor(pure=False, retries=_RETRIES)
        self._checked = self._had_workers = time.monotonic()
        self.lines = run_in_subprocess(all_lines, project, "while it was imported")

    def run(self, next_work: NextWork) -> Generator[tuple[Work, Result], None, None]:
        from .cluster_worker import play_on_worker

        running: dict[Future[bytes], Work] = {}
        try:
            while True:
                while (task := next_work()) is not None:
                    running[self._executor.submit(play_on_worker, self._plugin, pickle.dumps(task))] = task
                if not running:
                    return
                done, _ = wait(running, _INTERRUPT_CHECK_SECONDS, FIRST_COMPLETED)
                self._check_interrupt()
                for future in done:
                    yield running.pop(future), self._result_of(future)
        except NoMoreWork:
            return
        finally:
            for future in running:
                future.cancel()

    def _result_of(self, future: Future[bytes]) -> Result:
        try:
            result = pickle.loads(future.result())
        except CancelledError:
            raise ClusterError(f"the connection to the scheduler at {self._address} was lost") from None
        except Exception as error:
            raise ClusterError(f"the workers at {self._address} cannot play a match: {error}") from error
        if isinstance(result, PyfrcError):
            raise result
        assert isinstance(result, MatchResult | Shrunk)
        return result

    def _check_interrupt(self) -> None:
        super()._check_interrupt()
        now = time.monotonic()
        if now - self._checked < _CHECK_SECONDS:
            return
        self._checked = now
        if _count_workers(self._client, self._address):
            self._had_workers = now
        elif now - self._had_workers > _WITHOUT_WORKERS_SECONDS:
            raise ClusterError(f"the scheduler at {self._address} has lost all its workers")


@contextmanager
def _connected(address: str) -> Iterator[Any]:
    _check_address(address)
    from distributed import Client

    connect: Any = Client  # most of it has no types
    for name in logging.root.manager.loggerDict:
        if name.startswith(("asyncio", "distributed", "tornado")):  # what they log is shown as an error of ours
            logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = connect(address, timeout=_RESPONSE_SECONDS, set_as_default=False)
    except OSError as error:
        raise _unreachable(address, error) from error
    try:
        yield client
    finally:
        client.close()


def _check_address(address: str) -> None:
    """Check that something listens at a scheduler's address: Dask tries to connect for long, also where nothing does.

    :raises UsageError: when the address is not valid
    :raises ClusterError: when nothing listens there
    """
    try:
        parts = urlsplit(address if "://" in address else f"tcp://{address}")
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if host is None or port is None:
        raise UsageError(f"{address!r} is not the address of a scheduler, such as tcp://10.0.0.5:8786")
    try:
        socket.create_connection((host, port), _CONNECT_SECONDS).close()
    except OSError as error:
        raise _unreachable(address, error) from error


def _unreachable(address: str, error: OSError) -> ClusterError:
    return ClusterError(
        f"there is no Dask scheduler at {address}, or it cannot be reached ({error})",
        remedy="Start one with: dask scheduler. It prints its address.",
    )


def _count_workers(client: Any, address: str) -> int:
    try:
        return len(client.nthreads())
    except OSError:
        raise ClusterError(f"the connection to the scheduler at {address} was lost") from None


def _check_versions(client: Any, address: str) -> None:
    """:raises ClusterError: when there are no workers, or one cannot play the same matches as this computer"""
    from .cluster_worker import PACKAGES, versions

    if not _count_workers(client, address):
        raise ClusterError(
            f"the scheduler at {address} has no workers",
            remedy=f"Start at least one, on this or another computer: dask worker {address}",
        )
    expected = versions()
    found = client.get_versions(packages=PACKAGES)
    others = {f"the worker at {worker}": each for worker, each in found["workers"].items()}
    for where, each in {"the scheduler": found["scheduler"], **others}.items():
        there = {package: each["packages"].get(package) or "" for package in PACKAGES}
        there["Python"] = ".".join(each["host"]["python"].split(".")[:2])
        differences = [
            f"{name} {there[name] or 'is not installed'} ({wanted} here)"
            for name, wanted in expected.items()
            if there[name] != wanted
        ]
        if differences:
            raise ClusterError(
                f"{where} has another version: {', '.join(differences)}",
                remedy="A campaign has the same result on all computers only with the same versions.",
            )
