"""One robot project: its files and its settings."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING
from warnings import warn_explicit

from ..config.findings import SettingsWarning, settings_error
from ..config.settings import Settings, load_settings
from ..season import CURRENT
from ..wording import path_from
from .robot_files import RobotFiles, tests_beside
from .walk import SourceError, python_files, text_to_search, why_unreadable

if TYPE_CHECKING:
    from ..config.sim import SimConfig
    from ..config.sim_file import LoadedSimConfig

MAIN_FILE = "robot.py"
#: The error of a test that needs a physics module where there is none.
NO_PHYSICS = "there is no physics.py in this project"
#: The names of files with tests, as pytest's own.
TEST_FILES = ("test_*.py", "*_test.py")


@dataclass(frozen=True)
class Project:
    """One robot project.

    :param main_file: the file with the robot class, absolute
    :param class_name: the robot class's name, if the user has named it
    :param settings_file: the pyproject.toml that names the main file, if one does
    :param chosen_isolation: where robots run, if the command line says it
    """

    main_file: Path
    class_name: str | None = None
    settings_file: Path | None = None
    chosen_isolation: str | None = None

    @property
    def root(self) -> Path:
        """The directory of the robot's code."""
        return self.main_file.parent

    @cached_property
    def files(self) -> RobotFiles:
        return RobotFiles(self.root)

    @cached_property
    def pyproject(self) -> Path:
        """The project's pyproject.toml: beside the code, or in the directory above, as tests may be."""
        if self.settings_file is not None:
            return self.settings_file
        beside, above = self.root / "pyproject.toml", self.root.parent / "pyproject.toml"
        return above if above.is_file() and not beside.is_file() else beside

    @cached_property
    def settings(self) -> Settings:
        return load_settings(self.pyproject)

    @property
    def isolation(self) -> str:
        """Where robots run: in forks, or in interpreters that are used again."""
        return self.chosen_isolation or self.settings.test.isolation

    @cached_property
    def loaded_sim_config(self) -> LoadedSimConfig:
        """``sim/config.json`` with the lines of its keys; reading it warns about keys without effect, once."""
        from ..config.sim_file import load_sim_config

        loaded = load_sim_config(self.root)
        for finding in loaded.warnings:
            try:
                warn_explicit(SettingsWarning(finding.text), SettingsWarning, finding.file, finding.line or 1)
            except SettingsWarning:  # where warnings are errors
                raise settings_error([finding]) from None
        return loaded

    @property
    def sim_config(self) -> SimConfig:
        """The values of ``sim/config.json`` in effect."""
        return self.loaded_sim_config.config

    @property
    def game_specific_messages(self) -> tuple[str, ...]:
        """The messages that the field may send in autonomous; none in most seasons."""
        return self.sim_config.game_specific_messages if self._has_sim_config else CURRENT.field.messages

    @property
    def auto_joysticks(self) -> bool:
        """Whether the driver station sends joystick data in autonomous; in most seasons, it does not."""
        return self.sim_config.field.auto_joysticks if self._has_sim_config else CURRENT.field.auto_joysticks

    @property
    def _has_sim_config(self) -> bool:
        """Whether there is a ``sim/config.json``. Most projects have none, and reading it imports pydantic."""
        return os.path.lexists(self.root / "sim" / "config.json")

    @property
    def physics_file(self) -> Path:
        """The path of the project's physics module, which may not exist."""
        return self.root / "physics.py"

    @cached_property
    def misplaced_physics(self) -> Path | None:
        """A physics module elsewhere in the project, such as in ``sim``, if there is none at `physics_file`."""
        if self.physics_file.is_file():
            return None
        named = [file for file in python_files(self.root) if file.name == self.physics_file.name]
        candidates = [*named, self.root.parent / self.physics_file.name]
        return next((file for file in candidates if "class PhysicsEngine" in text_to_search(file)), None)

    def shown(self, file: Path) -> str:
        """Return the path of a file as the user sees it: relative to the project."""
        return Path(path_from(self.root, file)).as_posix()

    @property
    def test_directories(self) -> tuple[Path, Path]:
        """The possible directories of tests, in search order."""
        return self.root / "tests", tests_beside(self.root)

    @cached_property
    def invariant_files(self) -> tuple[Path, ...]:
        """The files among the project's tests that may have rules (`pyfrc.invariant`)."""
        tests = self.find_tests()
        directories = self.test_directories if tests is None else (tests,)
        found = (tuple(filter(_may_have_rules, python_files(directory))) for directory in directories)
        return next(filter(None, found), ())

    def find_tests(self) -> Path | None:
        """Return the directory of the project's tests, or None if there are no test files."""
        for directory in self.test_directories:
            if any(file.is_file() and any(map(file.match, TEST_FILES)) for file in python_files(directory)):
                return directory
        return None

    def unreadable_sources(self) -> list[SourceError]:
        """Return an error for each Python file of the project that cannot be read."""
        beside = self.test_directories[1]
        places = [self.root] if beside.is_relative_to(self.root) else [self.root, beside]
        errors = (why_unreadable(file) for place in places for file in python_files(place))
        return [error.within(self.files) for error in errors if error is not None]


_PYFRCS_NAME = re.compile(r"@\s*pyfrc\s*\.|from\s+pyfrc\s+import")


def _may_have_rules(file: Path) -> bool:
    text = text_to_search(file)
    # Any name of pyfrc's own, so that a misspelled decorator is an error of that file.
    return ("pyfrc" in text and "invariant" in text) or _PYFRCS_NAME.search(text) is not None
