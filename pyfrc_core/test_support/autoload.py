"""The pytest plugin that pytest loads automatically: fixtures for a plain ``pytest`` in a robot project.

An editor's test explorer runs pytest in this way. The module imports nothing at the top, since every pytest run in the
environment loads it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

_LIBRARIES = ("wpilib", "commands2", "magicbot")


def pytest_configure(config: pytest.Config) -> None:
    if config.pluginmanager.hasplugin("pyfrc.robot"):
        return None  # `pyfrc test` has registered its own
    for start in _start_directories(config):
        for directory in (start, *start.parents):
            if _is_robot_project(directory):
                return _register(config, directory)
    return None


def _start_directories(config: pytest.Config) -> list[Path]:
    """Return the directories named on the command line, then the current one."""
    here = Path(config.invocation_params.dir)
    named = [here / str(argument).partition("::")[0] for argument in config.args]
    return [path if path.is_dir() else path.parent for path in named if path.exists()] + [here]


def _is_robot_project(directory: Path) -> bool:
    """Return whether robot.py imports a robot library, or the settings have a section for pyfrc."""
    main, settings = directory / "robot.py", directory / "pyproject.toml"
    if main.is_file():
        text = main.read_text("utf-8", "replace").replace("\0", "")  # in UTF-16, every second byte is 0
        if any(library in text for library in _LIBRARIES):
            return True
    return settings.is_file() and "[tool.pyfrc" in settings.read_text("utf-8", "replace")


def _register(config: pytest.Config, directory: Path) -> None:
    import pytest

    from ..errors import PyfrcError
    from ..project import find_project
    from ..project.hidden_libraries import refuse_hidden_libraries
    from .isolation.loop import IsolatedTests
    from .pytest_plugin import PyFrcPlugin
    from .summary import SummaryPlugin

    try:
        project = find_project(directory)
        refuse_hidden_libraries(project.root, project.main_file)
        plugin = PyFrcPlugin(None, project.main_file, project.root, project=project)
    except PyfrcError as error:
        raise pytest.UsageError(str(error)) from None
    config.pluginmanager.register(plugin, "pyfrc.robot")
    config.pluginmanager.register(IsolatedTests(plugin), "pyfrc.isolation")
    config.pluginmanager.register(SummaryPlugin(project), "pyfrc.summary")
