"""Find tables and keys of pyproject.toml that have no effect because of their name, such as ``[tool.pyfcr.test]``."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from typing import TYPE_CHECKING

from ...config.toml_file import TomlFile
from ...errors import PyfrcError
from ...explain.names import meant
from .code_warning import CodeWarning

if TYPE_CHECKING:
    from ...project import Project

_TOOLS = ("pyfrc", "robotpy")
#: The keys of ``[tool.robotpy]``; that of 2024 has another name today.
_OF_ROBOTPY = ("robotpy_version", "components", "requires", "team_number")
_RENAMED = {"robotpy_extras": "components"}


def find_misspelled_settings(project: Project) -> Iterator[CodeWarning]:
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
