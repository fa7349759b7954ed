"""All checks of the robot code that is imported for mistakes that raise no error here."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches

from ...config.toml_file import TomlFile
from ...errors import PyfrcError
from ...explain.names import meant
from ...project import Project
from .enum_values import find_early_reads, find_sticks_read_once, find_wrong_comparisons
from .foreign_paths import find_foreign_paths
from .kinds import Kinds
from .lost_commands import find_lost_commands
from .misspelled_methods import find_misspelled_methods
from .never_used import find_never_used, find_unmatched_keys
from .no_effect import find_lines_without_effect
from .opmodes_never_run import find_opmodes_never_run
from .sources import CodeWarning, sources
from .wrong_moments import find_wrong_moments
from .wrong_tests import find_wrong_tests
from .wrong_units import find_wrong_units

_TOOLS = ("pyfrc", "robotpy")
#: The keys of ``[tool.robotpy]``; that of 2024 has another name today.
_OF_ROBOTPY = ("robotpy_version", "components", "requires", "team_number")
_RENAMED = {"robotpy_extras": "components"}


def find_code_warnings(project: Project) -> list[CodeWarning]:
    """Return the mistakes in the project's imported modules, and in the names of its settings."""
    files = list(sources(project))
    kinds = Kinds(files)
    robots = [each for each in files if not each.is_test]
    return [
        *find_misspelled_methods(project),
        *find_opmodes_never_run(project),
        *find_misplaced_physics(project),
        *find_foreign_paths(robots),
        *find_lines_without_effect(kinds),
        *find_never_used(kinds),
        *find_unmatched_keys(robots),
        *find_lost_commands(kinds),
        *find_wrong_moments(kinds),
        *find_wrong_units(kinds),
        *find_wrong_tests(kinds),
        *find_wrong_comparisons(files),
        *find_early_reads(robots),
        *find_sticks_read_once(kinds),
        *find_misspelled_settings(project),
    ]


def find_misplaced_physics(project: Project) -> list[CodeWarning]:
    """Return the physics module that is not beside the robot's file, if there is none there: nothing would move."""
    file = project.misplaced_physics
    if file is None:
        return []
    text = f"pyfrc does not read this file: {file.name} belongs beside {project.main_file.name}"
    return [CodeWarning(project.shown(file), text, f"Move it to {project.root}.")]


def find_misspelled_settings(project: Project) -> Iterator[CodeWarning]:
    """Yield the tables and keys of pyproject.toml that their names leave without effect, as ``[tool.pyfcr.test]``."""
    if not project.pyproject.is_file():
        return
    try:
        file = TomlFile(project.pyproject)
        tools, robotpy = file.table_at("tool") or {}, file.table_at("tool", "robotpy") or {}
    except (PyfrcError, OSError):  # reported where the settings are read
        return
    for name, table in file.content.items():
        if (
            isinstance(table, dict)
            and name != "tool"
            and (tool := next((each for each in _TOOLS if each in table), ""))
        ):
            yield _no_effect(file, (name,), f"[{name}.{tool}]", f"Write [tool.{tool}]")
    for name in tools:
        close = get_close_matches(name.lower(), _TOOLS, n=1, cutoff=0.75) if name not in _TOOLS else []
        if close and close[0] != name:
            yield _no_effect(file, ("tool", name), f"[tool.{name}]", f"Did you mean [tool.{close[0]}]?")
    for key in robotpy:
        instead = _RENAMED.get(key)
        remedy = f"Write {instead}" if instead else meant(key, list(_OF_ROBOTPY))
        if key not in _OF_ROBOTPY and remedy:
            yield _no_effect(file, ("tool", "robotpy", key), f"{key} under [tool.robotpy]", remedy)


def _no_effect(file: TomlFile, path: tuple[str, ...], what: str, remedy: str) -> CodeWarning:
    return CodeWarning(file.place_of(*path), f"{what} has no effect: nothing reads this name", remedy)
