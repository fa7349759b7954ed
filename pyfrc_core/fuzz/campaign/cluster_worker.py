"""The part of a campaign on a cluster that runs in Dask's worker processes.

A Dask worker has threads, so that it must not be forked. Each of its threads that plays a match uses an interpreter of
its own, which forks its matches as a campaign on one computer does. Tasks and results are pickled bytes here, so that
neither Dask's workers nor its scheduler import WPILib.
"""

from __future__ import annotations

import os
import pickle
import sys
import tempfile
import threading
import traceback
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import cache, partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING

from distributed import Worker, WorkerPlugin, get_worker

from ...errors import PyfrcError
from ...processes.interpreter import Interpreter
from ...processes.worker import Send

if TYPE_CHECKING:
    from ...processes.crash_report import CrashLog
    from ...project import Project
    from ..match.work import Result
    from ..oracle.failure import FuzzFailure
    from .executors import WorkExecutor
    from .packed_project import PackedProject

#: The packages whose versions must be the same everywhere.
PACKAGES = ("pyfrc", "wpilib")


def versions() -> dict[str, str]:
    """Return the versions of Python and `PACKAGES` in this process."""
    found = {"Python": "{}.{}".format(*sys.version_info)}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = ""
    return found


class ProjectOnWorker(WorkerPlugin):
    """Keeps a project and the processes that play its matches on a worker, until it is unregistered.

    :param packed: the project, a pickled `PackedProject`
    :param environment: variables of the processes
    :param expected: see `versions`
    """

    def __init__(self, packed: bytes, environment: Mapping[str, str], expected: Mapping[str, str]) -> None:
        self._packed = packed
        self._environment = dict(environment)
        self._expected = dict(expected)

    def setup(self, worker: Worker) -> None:
        """Make the directory of this project, which Dask's own directory for temporary files contains."""
        self._lock = threading.Lock()
        self._closed = False
        self._all: list[Interpreter] = []
        self._idle: list[Interpreter] = []
        self._directory = tempfile.TemporaryDirectory(
            prefix="pyfrc-", dir=worker.local_directory, ignore_cleanup_errors=True
        )
        self._temporary = Path(self._directory.name, "temporary")
        self._temporary.mkdir()
        packed: PackedProject = pickle.loads(self._packed)
        self._project = packed.unpack(Path(self._directory.name, "project"))
        self._sent_from = packed.project.root
        self._versions = versions()

    def teardown(self, worker: Worker) -> None:
        """End the processes and remove the directory."""
        with self._lock:
            self._closed = True
            for interpreter in self._all:
                interpreter.close()
        self._directory.cleanup()

    def play(self, task: bytes) -> bytes:
        """Return the pickled result of a pickled task, or the error of the project's code.

        :raises EOFError: when the process that played it has ended
        """
        if self._versions != self._expected:
            return pickle.dumps(PyfrcError(f"a worker has {self._versions}, this computer has {self._expected}"))
        interpreter = self._take()
        worker = interpreter.begin(partial(_play, self._project, self._sent_from, task))
        worker.wait()
        results: list[bytes] = list(worker.messages())
        if not results:
            raise EOFError("a process that plays matches on a worker has ended")
        worker.close()
        with self._lock:
            self._idle.append(interpreter)
        return results[0]

    def _take(self) -> Interpreter:
        with self._lock:
            if self._closed:
                raise EOFError("the campaign has ended")
            if self._idle:
                return self._idle.pop()
            temporary = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(self._temporary))
            # It ends with its standard input: the thread that starts it may end before this process.
            environment = {**self._environment, **temporary}
            interpreter = Interpreter(_Unchanged, environment=environment, ends_with_owner=False)
            self._all.append(interpreter)
            return interpreter


def play_on_worker(plugin: str, task: bytes) -> bytes:
    """Return the pickled result of a task; called by Dask's worker.

    :param plugin: the name of the `ProjectOnWorker`
    """
    on_worker: ProjectOnWorker = get_worker().plugins[plugin]  # type: ignore[assignment]
    return on_worker.play(task)


# -- in the process that plays the matches -----------------------------------------------------------------------------


class _Unchanged:
    """The state of an interpreter whose matches run in processes of their own: nothing of them is left in it."""

    def restore(self) -> Sequence[str]:
        return ()


_open = ExitStack()


@cache
def _executor_of(project: Project) -> WorkExecutor:
    """Return the executor for this project; the first match opens it."""
    from .executors import open_match_executor

    os.chdir(project.root)
    return _open.enter_context(open_match_executor(project, jobs=1))


def _play(project: Project, sent_from: Path, task: bytes, send: Send, log: CrashLog) -> None:
    """Play one match, and send its pickled result, or the error of the project's code.

    :param project: the project on the worker
    :param sent_from: its root on the computer that has sent it
    """
    try:
        left = [pickle.loads(task)]
        ((_, result),) = _executor_of(project).run(lambda: left.pop() if left else None)
        send(pickle.dumps(_with_paths_of_sender(result, str(project.root), str(sent_from))))
    except PyfrcError as error:
        send(pickle.dumps(error))
    except Exception:
        send(pickle.dumps(PyfrcError(f"a mistake in pyfrc itself, on a worker:\n{traceback.format_exc()}")))


def _with_paths_of_sender(result: Result, here: str, there: str) -> Result:
    """Return the result as on the computer that has sent the project: texts may have the path of a file."""

    from ..match.work import Shrunk

    def moved(failure: FuzzFailure) -> FuzzFailure:
        return replace(failure, text=failure.text.replace(here, there), calls=failure.calls.replace(here, there))

    failure = None if result.failure is None else moved(result.failure)
    if isinstance(result, Shrunk):
        return replace(result, failure=failure or result.failure)
    noted = tuple(note._replace(failure=moved(note.failure)) for note in result.noted)
    return replace(result, failure=failure, noted=noted)
