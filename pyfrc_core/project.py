"""Where the robot project is, which class is its robot, and what its settings say."""

from __future__ import annotations

import importlib.util
import os
import re
import sys
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any
from warnings import warn_explicit

from .config.findings import SettingsWarning, settings_error
from .config.settings import Settings, load_settings
from .encoding import find_wrong_encoding
from .errors import ProjectError, RobotCodeError, text_of
from .keyboard_input import refuse_keyboard_input
from .robot_files import RobotFiles

if TYPE_CHECKING:
    from .config.sim import SimConfig
    from .config.sim_file import LoadedSimConfig

MAIN_FILE = "robot.py"

#: So many projects are named of those in a directory that is none itself.
MOST_NAMED = 5

#: The modules whose robot classes are there to be derived from.
_LIBRARIES = ("wpilib", "commands2", "magicbot")

_ROBOT_METHODS = frozenset({"robotInit", "teleopInit", "teleopPeriodic", "autonomousInit", "autonomousPeriodic"})
_ROBOT_CLASS = re.compile(
    r"^class \w+\((?:\w+\.)?(?:(?:Timed|TimedCommand|Magic)Robot|(?:Iterative)?RobotBase)\):", re.M
)

#: In what Python says of a file that it cannot decode.
_OF_ENCODING = re.compile(r"null bytes|Non-UTF-8|codec can't decode")


@dataclass(frozen=True)
class Project:
    """One robot project.

    :param main_file: the file with the robot class, absolute
    :param class_name: the robot class's name, where the user has said it
    :param settings_file: the pyproject.toml that names the main file, where one does
    """

    main_file: Path
    class_name: str | None = None
    settings_file: Path | None = None

    @property
    def root(self) -> Path:
        """The directory of the robot's code."""
        return self.main_file.parent

    @cached_property
    def files(self) -> RobotFiles:
        return RobotFiles(self.root)

    @cached_property
    def pyproject(self) -> Path:
        """The project's pyproject.toml: beside the code, or one above it as its tests may be."""
        if self.settings_file is not None:
            return self.settings_file
        beside, above = self.root / "pyproject.toml", self.root.parent / "pyproject.toml"
        return above if above.is_file() and not beside.is_file() else beside

    @cached_property
    def settings(self) -> Settings:
        return load_settings(self.pyproject)

    @cached_property
    def loaded_sim_config(self) -> LoadedSimConfig:
        """``sim/config.json`` with its places; read once, when what has no effect in it is told as a warning."""
        from .config.sim_file import load_sim_config

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
        # Most projects have no such file: asked first, since reading it takes pydantic.
        if not os.path.lexists(self.root / "sim" / "config.json"):
            return ()
        return self.sim_config.game_specific_messages

    @property
    def physics_file(self) -> Path:
        """Where the project's physics module is, if it has one."""
        return self.root / "physics.py"

    @property
    def test_directories(self) -> tuple[Path, Path]:
        """Where tests may be, in the order in which they are looked for."""
        return self.root / "tests", self.root.parent / "tests"

    def find_tests(self) -> Path | None:
        """The directory of the project's tests, if it has any test files."""
        for directory in self.test_directories:
            if any(directory.glob("**/test_*.py")) or any(directory.glob("**/*_test.py")):
                return directory
        return None

    def load(self) -> type[Any]:
        """Import the robot program and answer its robot class.

        :raises RobotCodeError: when the user's code fails, naming the user's line
        :raises ProjectError: when there is not exactly one robot class to choose
        """
        return self.choose_class(self.import_file(self.main_file))

    def import_file(self, file: Path) -> ModuleType:
        """Import one of the program's files, as the module of its name.

        :raises RobotCodeError: when it fails, naming the user's line
        """
        name, where = file.stem, file.name
        loaded = sys.modules.get(name)
        if loaded is not None and getattr(loaded, "__file__", None) == str(file):
            return loaded  # a test file has imported it already
        if sys.path[:1] != [str(self.root)]:
            sys.path.insert(0, str(self.root))
        specification = importlib.util.spec_from_file_location(name, file)
        if specification is None or specification.loader is None:
            raise ProjectError("this is not a Python file", where=where)
        module = importlib.util.module_from_spec(specification)
        sys.modules[name] = module
        from .runtime.own_process import explained_exit
        from .runtime.watchdog import importing

        refuse_keyboard_input(self.files)
        try:
            with importing(self.files, self.settings.test.hang_seconds), explained_exit(self.files):
                specification.loader.exec_module(module)
        except (SyntaxError, UnicodeDecodeError, ValueError) as error:
            del sys.modules[name]
            self._explain_encoding(file, error)
            if not isinstance(error, SyntaxError):
                raise self._failed_import(file, error) from error
            place = self.files.relative(error.filename or where) + (f":{error.lineno}" if error.lineno else "")
            text = f"\n    {error.text.strip()}" if error.text else ""
            raise RobotCodeError(f"SyntaxError: {error.msg}{text}", where=place) from error
        except RobotCodeError:  # it names its place
            del sys.modules[name]
            raise
        except BaseException as error:
            del sys.modules[name]
            raise self._failed_import(file, error) from error
        return module

    def _failed_import(self, file: Path, error: BaseException) -> RobotCodeError:
        """What the program raised while it was imported, with its line and what to do."""
        from .hidden_libraries import LIBRARIES, find_hidden_by_any_name
        from .runtime.endings import TestFroze

        place = self.files.innermost_line(error.__traceback__) or file.name
        remedy = "This happens while the file is imported."
        if isinstance(error, TestFroze):
            remedy += " Is it an endless loop? If it only takes long: hang_seconds under [tool.pyfrc.test]."
            return RobotCodeError(str(error), where=place, remedy=remedy)
        if isinstance(error, SystemExit):
            remedy += ' Does it call wpilib.run()? Remove that, or put it under: if __name__ == "__main__":'
        elif isinstance(error, ModuleNotFoundError):
            remedy += " Is the name right, and its package installed?"
            if (self.root / "requirements.txt").is_file():
                remedy += " Your project's packages: python -m pip install -r requirements.txt"
        elif isinstance(error, NameError) and error.name in {*LIBRARIES, *sys.stdlib_module_names}:
            remedy += f" Is this line missing at the top: import {error.name}"
        if isinstance(error, (ImportError, AttributeError)):
            for hidden in find_hidden_by_any_name(self.root, self.main_file):
                remedy += f" {hidden.text}. {hidden.remedy}"
        return RobotCodeError(text_of(error), where=place, remedy=remedy)

    def _explain_encoding(self, file: Path, error: Exception) -> None:
        """:raises RobotCodeError: when the import failed because a file of the program is not in UTF-8"""
        if _OF_ENCODING.search(str(error)) is None:
            return
        named = Path(getattr(error, "filename", None) or "")
        # Python does not always name the file.
        for suspect in [named] if named.is_file() else [file, *sorted(self.root.rglob("*.py"))]:
            if not self.files.is_robot_code(str(suspect)):
                continue
            wrong = find_wrong_encoding(suspect)
            if wrong is not None:
                place = self.files.relative(str(suspect)) + (f":{wrong.line}" if wrong.line else "")
                raise RobotCodeError(wrong.message, where=place, remedy=wrong.remedy) from error

    def choose_class(self, module: ModuleType) -> type[Any]:
        import wpilib

        where = self.main_file.name
        robots = {
            value.__name__: value
            for value in vars(module).values()
            if isinstance(value, type)
            and issubclass(value, wpilib.RobotBase)
            and value.__module__.partition(".")[0] not in _LIBRARIES
        }
        here = {name: robot for name, robot in robots.items() if robot.__module__ == module.__name__}
        # A robot class kept in another file of the project and imported here counts when there is none here.
        robots = here or robots
        wanted = self.class_name or self.settings.robot_class
        if wanted is not None:
            if wanted not in robots:
                known = ", ".join(sorted(robots)) or "none"
                raise ProjectError(f"there is no robot class {wanted!r}", where=where, remedy=f"There is: {known}.")
            return robots[wanted]
        # A class that others here derive from is their base, not a robot of its own.
        bases = {base for robot in robots.values() for base in robot.__mro__[1:]}
        candidates = [robot for robot in robots.values() if robot not in bases]
        if not candidates:
            if (alike := _without_base(module)) is not None:
                raise ProjectError(
                    f"the class {alike} is not derived from a robot class",
                    where=f"{where}:{_line_of_class(self.main_file, alike)}",
                    remedy=f"Write: class {alike}(wpilib.TimedRobot):",
                )
            raise ProjectError(
                "there is no robot class in this file",
                where=where,
                remedy="Define one, such as: class MyRobot(wpilib.TimedRobot). "
                "If it is in another file, name that with --main FILE.",
            )
        if len(candidates) > 1:
            lines = ", ".join(
                f"{robot.__name__} ({where}:{_line_of_class(self.main_file, robot.__name__)})" for robot in candidates
            )
            raise ProjectError(
                f"there are {len(candidates)} robot classes: {lines}",
                where=where,
                remedy=f"Choose one with --robot-class {candidates[0].__name__}, "
                f'or with robot_class = "{candidates[0].__name__}" under [tool.pyfrc] in pyproject.toml.',
            )
        return candidates[0]


def _without_base(module: ModuleType) -> str | None:
    """The name of a class that has a robot's methods, but nothing that would call them."""
    for value in vars(module).values():
        own = isinstance(value, type) and value.__module__ == module.__name__ and value.__bases__ == (object,)
        if own and _ROBOT_METHODS.intersection(vars(value)):
            return str(value.__name__)
    return None


def _line_of_class(file: Path, name: str) -> int:
    import ast

    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.ClassDef) and node.name == name:
            return node.lineno
    return 1


def find_project(start: Path | None = None, main: Path | None = None, class_name: str | None = None) -> Project:
    """The robot project that a command is about.

    :param start: the project's directory, when the user names it; else the current one and those above are searched
    :param main: the file with the robot class, when the user names it
    :raises ProjectError: saying where was looked and for what
    """
    if main is not None:
        file = (start / main if start is not None and not main.is_absolute() else main).absolute()
        if not file.is_file():
            what = f"{main} is a directory" if file.is_dir() else f"there is no file {main}"
            raise ProjectError(what, remedy="--main names the file with your robot class.")
        return Project(file.resolve(), class_name)
    if start is not None:
        if not start.is_dir():
            raise ProjectError(f"there is no directory {start}", remedy="--project names your robot project.")
        project = _project_in(start.resolve(), class_name)
        if project is None:
            raise _nothing_found(start, "in")
        return project
    here = Path.cwd()
    for directory in (here, *here.parents):
        project = _project_in(directory, class_name)
        if project is not None:
            return project
    raise _nothing_found(here, "in or above")


def _project_in(directory: Path, class_name: str | None) -> Project | None:
    pyproject = directory / "pyproject.toml"
    main = load_settings(pyproject).main
    if main is not None:
        file = directory / main
        if not file.is_file():
            raise ProjectError(f"main = {main!r} under [tool.pyfrc], but there is no such file", where=pyproject.name)
        return Project(file.resolve(), class_name, pyproject)
    if (directory / MAIN_FILE).is_file():
        return Project(directory / MAIN_FILE, class_name)
    return None


def _nothing_found(directory: Path, how: str) -> ProjectError:
    below = _projects_below(directory)
    if below:
        also = f" (or {', '.join(f'./{each.as_posix()}' for each in below[1:])})" if len(below) > 1 else ""
        there = (directory / below[0] if how == "in" else below[0]).as_posix()
        there = f'"{there}"' if " " in there else there
        return ProjectError(
            f"there is no {MAIN_FILE} {how} {directory}, but there is one in ./{below[0].as_posix()}{also}",
            remedy=f"Go there with: cd {there}. Or name it with: --project {there}",
        )
    nearly = next((file.name for file in directory.glob("*.py") if file.name.lower() == MAIN_FILE), None)
    other = next((file.name for file in sorted(directory.glob("*.py")) if _defines_robot(file)), None)
    if nearly is None and other is not None:
        return ProjectError(
            f"no robot project found: there is no {MAIN_FILE} {how} {directory}, but a robot class in {other}",
            remedy=f"Rename {other} to {MAIN_FILE}, or name it with --main {other}",
        )
    return ProjectError(
        f"no robot project found: there is no {MAIN_FILE} {how} {directory}"
        + (f" (but a {nearly}: rename it)" if nearly else ""),
        remedy="Go to your project's directory, name it with --project DIR, name the file with --main FILE, "
        "or make a new project with: pyfrc init",
    )


def _defines_robot(file: Path) -> bool:
    try:
        return _ROBOT_CLASS.search(file.read_text("utf-8", "replace")) is not None
    except OSError:
        return False


def _projects_below(directory: Path) -> list[Path]:
    """The directories in this one that hold a robot project, as in a repository with several of them."""
    try:
        found = sorted(file.parent for file in directory.glob(f"*/{MAIN_FILE}") if file.is_file())
    except OSError:
        return []
    return [each.relative_to(directory) for each in found if not each.name.startswith(".")][:MOST_NAMED]
