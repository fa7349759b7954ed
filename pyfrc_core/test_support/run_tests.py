"""Run a project's tests, for `pyfrc test`."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from ..errors import PyfrcError, UsageError
from ..processes.reuse import Interpreters
from ..project import Project
from ..runtime.threads.fork_obstacles import reasons_not_to_fork
from ..season import CURRENT
from ..wording import counted, path_from
from .isolation.interpreters import start_interpreters
from .isolation.loop import IsolatedTests
from .options import READY_MADE_DIRECTORY, READY_MADE_TESTS, TestOptions
from .pytest_plugin import PyFrcPlugin
from .remembered_passes import RememberedPasses
from .summary import SummaryPlugin
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


class _ChangesBack:
    """Change back to the user's directory when pytest has read its arguments."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory

    @pytest.hookimpl(tryfirst=True)
    def pytest_load_initial_conftests(self) -> None:
        os.chdir(self._directory)


class _ReadyMadeTests:
    """Run each ready-made test once, although the project may import it, too; and print how many there were."""

    def __init__(self) -> None:
        self._text = ""

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        own = {getattr(item, "function", None) for item in items if not _is_ready_made(item)}
        items[:] = [item for item in items if not (_is_ready_made(item) and getattr(item, "function", None) in own)]

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        modules = [getattr(getattr(item, "function", None), "__module__", "") for item in session.items]
        ready_made = sum(name.startswith(READY_MADE_TESTS) for name in modules)
        self._text = f"{counted(ready_made, 'ready-made test')} and {counted(len(modules) - ready_made, 'other test')}"

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        terminalreporter.write_line(f"--builtin: {self._text}")


def _is_ready_made(item: pytest.Item) -> bool:
    return item.path.parent == READY_MADE_DIRECTORY


def run_tests(
    project: Project,
    options: TestOptions,
    *,
    builtin: bool = False,
    pytest_args: Sequence[str] = (),
    interpreters: Interpreters | None = None,
) -> int:
    """Run the project's tests, the ready-made ones, or both, and return pytest's exit code.

    :param builtin: run the ready-made tests, too, unless the project imports them
    :param pytest_args: passed on to pytest
    :param interpreters: those that were started for tests that cannot be forked
    :raises NoTestsError: when the project has no tests, and `builtin` is not set
    :raises RobotCodeError: when the robot's code cannot be imported
    """
    start = _start_directory(project)
    args = _arguments(project, builtin, pytest_args, start)
    for directory in (options.trace_directory, options.record_directory):
        if directory is not None:  # an error is reported once, and not by every test
            directory.mkdir(parents=True, exist_ok=True)

    plugin = PyFrcPlugin(None, project.main_file, project.root, project=project, options=options)
    plugin.robot_class()  # an import error is reported once, and not by every test
    with ExitStack() as ending:
        if interpreters is None and options.isolation == "auto" and reasons_not_to_fork():
            interpreters = ending.enter_context(closing(start_interpreters(project)))
        plugins = [
            plugin,
            IsolatedTests(plugin, interpreters),
            SummaryPlugin(project, whole=not any(map(_selects, pytest_args))),
            _NoUnusedHypothesis(),
            RememberedPasses(project, options, pytest_args, builtin),
            *([_ReadyMadeTests()] if builtin else []),
        ]
        here = Path.cwd()
        os.chdir(start)
        ending.callback(os.chdir, here)
        return int(pytest.main(args, plugins=[*plugins, _ChangesBack(here)]))


#: What pytest would replace in a path, or take for a parameter or a test's name.
_INTERPRETED = re.compile(r"\[|::|[$%]")


def _start_directory(project: Project) -> Path:
    """Return a directory relative to which pytest can read the project's paths: the current one, if possible.

    pytest has no way to write ``[``, ``::`` or ``$`` in a path. From the project's directory, none is needed.
    """
    here = Path.cwd()
    places = [path_from(here, each) for each in (project.root, project.pyproject.parent)]
    return project.root if any(map(_INTERPRETED.search, places)) else here


def _arguments(project: Project, builtin: bool, pytest_args: Sequence[str], start: Path) -> list[str]:
    """Return the arguments for pytest.

    :param start: the directory that paths are relative to
    """
    if any(not each.startswith("-") and Path(each).absolute() == project.main_file for each in pytest_args):
        remedy = "pyfrc finds it, and its tests, by itself: pyfrc test"
        raise UsageError(f"{project.main_file.name} is the robot program, and not a test file", remedy=remedy)
    unused = [f"-pno:{name}" for name in _UNUSED_PLUGINS if name not in " ".join(pytest_args)]
    args = [*unused, *(_moved(each, start) for each in pytest_args)]
    args += [f"--rootdir={path_from(start, project.pyproject.parent)}", *_configuration(project, start)]
    if any(map(_split, pytest_args)):
        return args
    directory = project.find_tests()
    if directory is not None:
        args.append(os.path.join(".", path_from(start, directory)))  # noqa: PTH118 - not the name of a package
    if builtin:
        modules = ("basic", "opmode_test") if CURRENT.opmodes else ("basic",)
        args += ["--pyargs", *(f"{READY_MADE_TESTS}.{module}" for module in modules)]
    if directory is not None or builtin:
        return args
    looked = " and ".join(dict.fromkeys(map(str, project.test_directories)))
    patterns = ("test_*.py", "*_test.py")
    remedies = list(find_uncollected(project.test_directories[0], set(), patterns))
    remedies.append(
        "Run the ready-made tests with: pyfrc test --builtin. Add them to the project with: pyfrc add-tests"
    )
    raise NoTestsError(
        f"this project has no tests: looked for files named {' or '.join(patterns)} in {looked}",
        remedy="\n  ".join(remedies),
    )


def _configuration(project: Project, start: Path) -> list[str]:
    """Return the arguments for the project's own pytest configuration.

    pytest itself searches only beside the test files.
    """
    for name in ("pytest.ini", ".pytest.ini", "pyproject.toml", "tox.ini", "setup.cfg"):
        file = project.pyproject.with_name(name)
        if file.is_file():
            return ["-c", path_from(start, file)]
    return []


def _selects(arg: str) -> bool:
    """Return whether an argument of pytest's may choose some of the tests."""
    return arg not in ("-q", "-v", "-x", "-s")


def _split(arg: str) -> tuple[str, str] | None:
    """Return the existing path that an argument of pytest's begins with, and the test in it; None without one."""
    parts = [] if arg.startswith("-") else arg.split("::")
    counts = range(len(parts), 0, -1)
    names = (("::".join(parts[:count]), "".join(f"::{each}" for each in parts[count:])) for count in counts)
    return next((name for name in names if Path(name[0]).exists()), None)


def _moved(arg: str, start: Path) -> str:
    """Return an argument of pytest's as it is written in another directory."""
    if start == Path.cwd() or (split := _split(arg)) is None:
        return arg
    return f"{path_from(start, Path(split[0]).absolute())}{split[1]}"
