"""The interpreters for tests that are not forked, which are started before this process has imported what it needs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

from ...errors import PyfrcError
from ...processes.crash_report import CrashLog
from ...processes.fork import is_forked
from ...processes.interpreter import InitialState
from ...processes.reuse import Interpreters
from ...processes.worker import Send
from ...project import Project
from ..options import TestOptions


@contextmanager
def opened_interpreters(project: Project, options: TestOptions) -> Iterator[Interpreters | None]:
    """Start the interpreters for tests that are not forked; None if tests are forked, or run in this process."""
    if options.isolation == "none" or is_forked(options.isolation):
        yield None
        return
    with closing(start_interpreters(project)) as interpreters:
        yield interpreters


def start_interpreters(project: Project) -> Interpreters:
    """Return the interpreters, of which one is started now."""
    interpreters = Interpreters(partial(_prepare, project.main_file), 1, keeps_output=True)
    interpreters.rehearse(partial(_import_robot, replace(project)))
    return interpreters


# -- on the other side -----------------------------------------------------------------------------------------------


def _prepare(main_file: Path) -> InitialState:
    """Import what each test needs; return the state in which each is to begin."""
    from ...project import Project
    from ...runtime.patches.install import patches
    from ...runtime.pristine.state import ProcessState
    from .. import pytest_plugin  # noqa: F401
    from . import messages, spawned  # noqa: F401

    project = Project(main_file)
    patches.install(project.files)
    return ProcessState(project.files)


def _import_robot(project: Project, send: Send, log: CrashLog) -> None:
    """Import the robot's code as each test does, for the libraries that it imports: the main process does it meanwhile.

    An error is reported there, and by each test.
    """
    from ...physics.engine import load_physics
    from ...runtime.loading import load_robot

    with suppress(PyfrcError):
        load_robot(project)
        if project.physics_file.is_file():
            load_physics(project)
