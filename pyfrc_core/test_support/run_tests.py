"""Run a project's tests, for `pyfrc test`."""

from __future__ import annotations

import signal
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from ..errors import PyfrcError, UsageError
from ..processes.fork import is_forked
from ..processes.prefork import PreforkedProcess
from ..processes.reuse import Interpreters
from ..project import Project
from ..runtime.threads.fork_obstacles import reasons_not_to_fork
from ..season import CURRENT
from .isolation.loop import IsolatedTests
from .options import READY_MADE_TESTS, TestOptions
from .pytest_plugin import PyFrcPlugin
from .remembered_passes import RememberedPasses
from .summary import SummaryPlugin, warn_of_mistakes
from .uncollected import find_uncollected


class NoTestsError(PyfrcError):
    """The project has no tests."""


#: Plugins of libraries that pyfrc depends on, and that robots' tests do not use.
_UNUSED_PLUGINS = ("anyio", "platformdirs")


class _NoUnusedHypothesis:
    """Unregister hypothesis' plugin after a run that did not use it.

    The plugin would import hypothesis for an empty summary.
    """

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        plugins = session.config.pluginmanager
        if "hypothesis" not in sys.modules and (unused := plugins.getplugin("hypothesispytest")):
            plugins.unregister(unused)


def run_tests(
    project: Project,
    options: TestOptions,
    *,
    builtin: bool = False,
    pytest_args: Sequence[str] = (),
    interpreters: Interpreters | None = None,
) -> int:
    """Run the project's tests, or the ready-made ones, and return pytest's exit code.

    :param builtin: run the ready-made tests if the project has none
    :param pytest_args: passed on to pytest
    :param interpreters: those that were started for tests that cannot be forked
    :raises NoTestsError: when the project has no tests, and `builtin` is not set
    :raises RobotCodeError: when the robot's code cannot be imported
    """
    args = _arguments(project, builtin, pytest_args)
    for directory in (options.trace_directory, options.record_directory):
        if directory is not None:  # an error is reported once, and not by every test
            directory.mkdir(parents=True, exist_ok=True)

    def session(imports_late: str = "") -> int:
        plugin = PyFrcPlugin(
            None, project.main_file, project.root, project=project, options=options, imports_late=imports_late
        )
        if not imports_late:
            plugin.robot_class()  # an import error is reported once, and not by every test
            if preforked is not None and (reasons := reasons_not_to_fork()):
                status = preforked.take_over("; ".join(reasons))
                warn_of_mistakes(project)  # the other process has not imported them
                return status
            if preforked is not None:
                preforked.dismiss()  # as long as it lives, what this process writes to is copied
        passes = RememberedPasses(project, options, pytest_args, builtin)
        plugins = [
            plugin,
            IsolatedTests(plugin, interpreters),
            SummaryPlugin(project, whole=not any(map(_selects, pytest_args))),
            _NoUnusedHypothesis(),
            passes,
        ]
        return int(pytest.main(args, plugins=plugins))

    preforked: PreforkedProcess | None = None
    if options.isolation != "none" and is_forked(options.isolation):
        preforked = PreforkedProcess(session)
    # SIGTERM, from an IDE or a CI system, ends a run like Ctrl-C: with the processes it has started.
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return session()
    finally:
        signal.signal(signal.SIGTERM, before)
        if preforked is not None:
            preforked.dismiss()


def _arguments(project: Project, builtin: bool, pytest_args: Sequence[str]) -> list[str]:
    """Return the arguments for pytest."""
    if any(not each.startswith("-") and Path(each).absolute() == project.main_file for each in pytest_args):
        remedy = "pyfrc finds it, and its tests, by itself: pyfrc test"
        raise UsageError(f"{project.main_file.name} is the robot program, and not a test file", remedy=remedy)
    unused = [f"-pno:{name}" for name in _UNUSED_PLUGINS if name not in " ".join(pytest_args)]
    args = [*unused, *pytest_args, f"--rootdir={project.pyproject.parent}", *_configuration(project)]
    if _names_tests(pytest_args):
        return args
    directory = project.find_tests()
    if directory is not None:
        return [*args, str(directory)]
    if builtin:
        modules = ("basic", "opmode_test") if CURRENT.opmodes else ("basic",)
        return [*args, "--pyargs", *(f"{READY_MADE_TESTS}.{module}" for module in modules)]
    looked = " and ".join(str(path) for path in project.test_directories)
    patterns = ("test_*.py", "*_test.py")
    remedies = list(find_uncollected(project.test_directories[0], set(), patterns))
    remedies.append(
        "Run the ready-made tests with: pyfrc test --builtin. Add them to the project with: pyfrc add-tests"
    )
    raise NoTestsError(
        f"this project has no tests: looked for files named {' or '.join(patterns)} in {looked}",
        remedy="\n  ".join(remedies),
    )


def _configuration(project: Project) -> list[str]:
    """Return the arguments for the project's own pytest configuration.

    pytest itself searches only beside the test files.
    """
    for name in ("pytest.ini", ".pytest.ini", "pyproject.toml", "tox.ini", "setup.cfg"):
        file = project.pyproject.with_name(name)
        if file.is_file():
            return ["-c", str(file)]
    return []


def _selects(arg: str) -> bool:
    """Return whether an argument of pytest's may choose some of the tests."""
    return arg not in ("-q", "-v", "-x", "-s")


def _names_tests(args: Sequence[str]) -> bool:
    """Return whether the user has named files to run."""
    return any(not arg.startswith("-") and Path(arg.partition("::")[0]).exists() for arg in args)
