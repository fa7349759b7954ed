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
        return  # `pyfrc test` has brought its own
    for start in _where_tests_are(config):
        main = _robot_program(start)
        if main is not None:
            _register(config, main)
            return


def _where_tests_are(config: pytest.Config) -> list[Path]:
    """The directories named on the command line, then the current one."""
    here = Path(config.invocation_params.dir)
    named = [here / str(argument).partition("::")[0] for argument in config.args]
    return [path if path.is_dir() else path.parent for path in named if path.exists()] + [here]


def _robot_program(start: Path) -> Path | None:
    for directory in (start, *start.parents):
        main = directory / "robot.py"
        if main.is_file():
            text = main.read_text("utf-8", "replace")
            return main if any(library in text for library in _LIBRARIES) else None
    return None


def _register(config: pytest.Config, main: Path) -> None:
    from ..project import Project
    from .isolation.loop import IsolatedTests
    from .pytest_plugin import PyFrcPlugin

    project = Project(main.resolve())
    plugin = PyFrcPlugin(None, project.main_file, project.root, project=project)
    config.pluginmanager.register(plugin, "pyfrc.robot")
    config.pluginmanager.register(IsolatedTests(plugin), "pyfrc.isolation")
