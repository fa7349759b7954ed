"""The pytest plugin that pytest loads automatically: fixtures for a plain ``pytest`` in a robot project.

An editor's test explorer runs pytest in this way. Every pytest run in the environment loads this module, so it imports
nothing of pyfrc at the top, and does nothing outside a robot project of the user's own.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

#: Where one of these lies, another project begins: a robot.py further up is none of its business.
_PROJECT_MARKS = ("pyproject.toml", "setup.py", "setup.cfg", ".git")

_ROBOT_LIBRARY = re.compile(r"^\s*(?:import|from)\b[^#\n]*\b(?:wpilib|commands2|magicbot|pykit)\b", re.M)
_ROBOT_CLASS = re.compile(r"^\s*class\s+(?:\w*Robot\w*\s*\(|\w+\s*\([^)]*Robot)|^[^#\n]*\bwpilib\.run\(", re.M)
_SETTINGS = re.compile(r"^\s*\[tool\.(?:pyfrc|robotpy)\b", re.M)
_OWN_MAIN = re.compile(r"^\s*\[tool\.pyfrc\][^\[]*^\s*main\s*=", re.M)


class _Inactive:
    """Says in a line why a robot project's fixtures are missing."""

    def __init__(self, reason: str) -> None:
        self._reason = reason

    def pytest_report_header(self) -> str:
        return f"pyfrc: not active: {self._reason}"


def pytest_configure(config: pytest.Config) -> None:
    if config.pluginmanager.hasplugin("pyfrc.robot"):
        return  # `pyfrc test` has registered its own
    if _is_run_by_wpilib(config):  # by `robotpy test` of WPILib 2027, which has fixtures of the same names
        from .beside_robotpy import FixturesOfPyfrc

        config.pluginmanager.register(FixturesOfPyfrc(), "pyfrc.beside_robotpy")
        return
    for start in _start_directories(config):
        directory = _robot_project_of(start)
        if directory is not None:
            reason = _other_owner(directory) or _unknown_wpilib() or _register(config, directory)
            if reason:
                config.pluginmanager.register(_Inactive(reason), "pyfrc.inactive")
            return


def _start_directories(config: pytest.Config) -> list[Path]:
    """Return the directories of the tests: those named on the command line, or else the current one."""
    here = Path(config.invocation_params.dir)
    named = [here / str(argument).partition("::")[0] for argument in config.args]
    return [path if path.is_dir() else path.parent for path in named if _exists(path)] or [here]


def _robot_project_of(start: Path) -> Path | None:
    """Return the directory of the robot project that tests in `start` belong to."""
    for directory in (start, *start.parents):
        if _is_robot_project(directory):
            return directory
        if any(_exists(directory / mark) for mark in _PROJECT_MARKS):
            return None
    return None


def _is_robot_project(directory: Path) -> bool:
    """Return whether robot.py has a robot class, or the settings are those of a robot project."""
    settings = _text(directory / "pyproject.toml")
    text = _text(directory / "robot.py").replace("\0", "")  # in UTF-16, every second byte is 0
    if not text:
        return _OWN_MAIN.search(settings) is not None
    has_class = _ROBOT_LIBRARY.search(text) is not None and _ROBOT_CLASS.search(text) is not None
    return has_class or _SETTINGS.search(settings) is not None


def _text(file: Path) -> str:
    try:
        return file.read_text("utf-8", "replace") if file.is_file() else ""
    except OSError:
        return ""


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # it may not be read, or its name is too long
        return False


def _other_owner(directory: Path) -> str:
    """Return the reason not to run a robot of another user, whose directory happens to be above the tests."""
    if not hasattr(os, "getuid"):
        return ""
    files = [directory / name for name in ("robot.py", "physics.py", "pyproject.toml")]
    other = next((file for file in files if _exists(file) and file.stat().st_uid != os.getuid()), None)
    return f"{other} belongs to another user. If you trust it, run: pyfrc test" if other else ""


def _is_run_by_wpilib(config: pytest.Config) -> bool:
    return any(type(plugin).__module__.startswith("wpilib.") for plugin in config.invocation_params.plugins or ())


def _unknown_wpilib() -> str:
    """Return the reason not to run beside a `wpilib` of another season, whose own tool may have the same fixtures."""
    from ..errors import ProjectError
    from ..season import installed_wpilib, refuse_unknown_wpilib

    wpilib = installed_wpilib()
    try:
        if wpilib is not None:
            refuse_unknown_wpilib(wpilib)
    except ProjectError as unknown:
        return unknown.message
    return ""


def _register(config: pytest.Config, directory: Path) -> str:
    """Register the fixtures, or return the reason why they cannot be."""
    import pytest

    try:
        from ..config.robotpy import load_season_settings
        from ..errors import PyfrcError
        from ..project import find_project
        from ..project.hidden_libraries import refuse_hidden_libraries
        from ..season import installed_wpilib, refuse_other_season

        try:
            project = find_project(directory)
            refuse_hidden_libraries(project.root, project.main_file)
            refuse_other_season(installed_wpilib(), load_season_settings(project.pyproject))

            from .isolation.loop import IsolatedTests
            from .pytest_plugin import PyFrcPlugin
            from .summary import SummaryPlugin

            plugin = PyFrcPlugin(None, project.main_file, project.root, project=project)
        except PyfrcError as error:
            raise pytest.UsageError(str(error)) from None
    except (ImportError, AttributeError) as error:  # packages that do not fit together must not end a run of pytest
        return f"{str(error).splitlines()[0]}. To see which package is wrong, run: pyfrc doctor"

    config.pluginmanager.register(plugin, "pyfrc.robot")
    config.pluginmanager.register(IsolatedTests(plugin), "pyfrc.isolation")
    config.pluginmanager.register(SummaryPlugin(project), "pyfrc.summary")
    return ""
