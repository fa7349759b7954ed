"""Import the robot's code, and explain why it cannot be imported."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

from ..encoding import find_wrong_encoding
from ..errors import ProjectError, RobotCodeError, text_of
from ..explain import Explanation, explain
from ..interruption import interruption
from ..processes.crash_report import reported_exit
from ..processes.lent_streams import lent_streams
from ..project import Project
from ..project.hidden_libraries import find_hidden_by_any_name
from ..project.walk import python_files, text_to_search
from ..wpi import robots, timing
from ..wpi.opmodes import DECORATED
from .checks.hang_detector import importing, watching_exit
from .checks.misspelled_methods import refuse_unawaited_methods
from .exceptions import TestFroze
from .keyboard_input import refuse_keyboard_input
from .patches.construction import refused
from .robot_class import choose_robot_class

#: Part of Python's messages about a file that it cannot decode.
_ENCODING_MESSAGE = re.compile(r"null bytes|Non-UTF-8|codec can't decode")

_WHILE_IMPORTED = "This happens while the file is imported."


def load_robot(project: Project) -> type[Any]:
    """Import the robot program and return its robot class. Call this before its run, whose time starts at 0 as here.

    :raises RobotCodeError: when the user's code fails, naming the user's line
    :raises ProjectError: when there is not exactly one robot class to choose
    """
    exit_watched = watching_exit(project.files, project.settings.test.hang_seconds)
    with timing.standing_at_zero(), refused(project.files), exit_watched:
        module = import_file(project, project.main_file)
        robot_class = choose_robot_class(project, module)
        if robots.can_have_opmodes(robot_class):
            _import_opmodes(project)
    refuse_unawaited_methods(project)
    return robot_class


def import_file(project: Project, file: Path, name: str | None = None) -> ModuleType:
    """Import one of the project's files.

    :param name: the module's name; by default that of the file
    :raises RobotCodeError: when the import fails, naming the user's line
    """
    name, where = name or file.stem, file.name
    loaded = sys.modules.get(name)
    if loaded is not None and getattr(loaded, "__file__", None) == str(file):
        return loaded  # a test file has imported it already
    if sys.path[:1] != [str(project.root)]:
        sys.path.insert(0, str(project.root))
    specification = importlib.util.spec_from_file_location(name, file)
    if specification is None or specification.loader is None:
        raise ProjectError("this is not a Python file", where=where)
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    _run_code(project, file, name, partial(specification.loader.exec_module, module))
    return module


def _import_opmodes(project: Project) -> None:
    """Import the files of opmodes that WPILib imports when it makes the robot: there, it goes on after an error."""
    directory = project.main_file.parent / "opmodes"
    if re.search(r"\bauto_discover\s*=\s*False", project.main_file.read_text("utf-8", "replace")):
        return
    for file in python_files(directory):
        if DECORATED.search(text_to_search(file)):
            parts = file.relative_to(directory.parent).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            _run_code(project, file, name, partial(importlib.import_module, name))


def _run_code(project: Project, file: Path, name: str, run: Callable[[], object]) -> None:
    """Run the code of a module while it is imported.

    :raises RobotCodeError: when it fails, naming the user's line
    """
    refuse_keyboard_input(project.files)
    try:
        with lent_streams(), importing(project.files, project.settings.test.hang_seconds), reported_exit(project.files):
            run()
    except BaseException as error:
        sys.modules.pop(name, None)
        interruption.check(error)
        if isinstance(error, RobotCodeError):  # it names its place
            raise
        if isinstance(error, (SyntaxError, UnicodeDecodeError, ValueError)):
            _refuse_wrong_encoding(project, file, error)
        raise _import_error(project, file, error) from error


def _import_error(project: Project, file: Path, error: BaseException) -> RobotCodeError:
    """Return what the program raised while it was imported as an error with the user's line and what to do."""
    place = project.files.innermost_line(error.__traceback__) or file.name
    if isinstance(error, TestFroze):
        place, _, text = str(error).partition(": ")
        text, _, advice = text.partition("\n")
        return RobotCodeError(text.rstrip("."), where=place, remedy=f"{_WHILE_IMPORTED} {advice}")
    explained = explain(error, project.files) or Explanation()
    remedy = explained.remedy or ("" if isinstance(error, SyntaxError) else _WHILE_IMPORTED)
    if isinstance(error, (ImportError, AttributeError)):
        for hidden in find_hidden_by_any_name(project.root, project.main_file):
            remedy += f" {hidden.text}. {hidden.remedy}"
    return RobotCodeError(explained.text or text_of(error), where=explained.place or place, remedy=remedy or None)


def _refuse_wrong_encoding(project: Project, file: Path, error: Exception) -> None:
    """:raises RobotCodeError: when the import failed because a file of the program is not in UTF-8"""
    if _ENCODING_MESSAGE.search(str(error)) is None:
        return
    named = Path(getattr(error, "filename", None) or "")
    # Python does not always name the file.
    for suspect in [named] if named.is_file() else [file, *python_files(project.root)]:
        if not project.files.is_robot_code(str(suspect)):
            continue
        wrong = find_wrong_encoding(suspect)
        if wrong is not None:
            place = project.files.relative(str(suspect)) + (f":{wrong.line}" if wrong.line else "")
            raise RobotCodeError(wrong.message, where=place, remedy=wrong.remedy) from error
