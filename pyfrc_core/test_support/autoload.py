"""What pytest loads by itself: the robot fixtures for a plain ``pytest`` in a robot project, nothing anywhere else.

An editor's test explorer runs pytest like this. Kept free of imports, since every pytest run of every project in the
environment pays for them.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

_LIBRARIES = ("wpilib", "commands2", "magicbot")


def pytest_configure(config: pytest.Config) -> None:
    if config.pluginmanager.hasplugin("pyfrc.robot"):
        return None  # `pyfrc test` has brought its own
    for start in _where_tests_are(config):
        for directory in (start, *start.parents):
            if _holds_robot(directory):
                return _register(config, directory)
    return None


def _where_tests_are(config: pytest.Config) -> list[Path]:
    """The directories named on the command line, then the current one."""
    here = Path(config.invocation_params.dir)
    named = [here / str(argument).partition("::")[0] for argument in config.args]
    return [path if path.is_dir() else path.parent for path in named if path.exists()] + [here]


def _holds_robot(directory: Path) -> bool:
    """Whether this is a robot project: its robot.py is one of a robot, or its settings name another."""
    main, settings = directory / "robot.py", directory / "pyproject.toml"
    if main.is_file():
        text = main.read_text("utf-8", "replace").replace("\0", "")  # of UTF-16, every second byte
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
    from .summary import Summary

    try:
        project = find_project(directory)
        refuse_hidden_libraries(project.root, project.main_file)
        plugin = PyFrcPlugin(None, project.main_file, project.root, project=project)
    except PyfrcError as error:
        raise pytest.UsageError(str(error)) from None
    config.pluginmanager.register(plugin, "pyfrc.robot")
    config.pluginmanager.register(IsolatedTests(plugin), "pyfrc.isolation")
    config.pluginmanager.register(Summary(project), "pyfrc.summary")
