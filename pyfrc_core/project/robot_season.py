"""Whether the installed WPILib is of the project's season."""

from __future__ import annotations

from ..config.toml_file import TomlFile
from ..season import installed_wpilib
from ..season import refuse_other_season as refuse
from .project import Project


def refuse_other_season(project: Project) -> None:
    """Refuse to go on with a WPILib of a season that is not the project's, or that pyfrc does not know.

    :raises ProjectError: with what to install
    """
    wanted, where = None, None
    if project.pyproject.is_file():
        file = TomlFile(project.pyproject)
        version = (file.table_at("tool", "robotpy") or {}).get("robotpy_version")
        if isinstance(version, str):
            wanted, where = version, file.place_of("tool", "robotpy", "robotpy_version")
    refuse(installed_wpilib(), wanted, where)
