"""All checks of the robot code that is imported for mistakes that raise no error here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .code_warning import CodeWarning
from .foreign_paths import find_foreign_paths
from .misplaced_physics import find_misplaced_physics
from .misspelled_methods import find_misspelled_methods
from .opmodes_never_run import find_opmodes_never_run

if TYPE_CHECKING:
    from ...project import Project


def find_code_warnings(project: Project) -> list[CodeWarning]:
    """Return the mistakes in the project's imported modules."""
    return [
        *find_misspelled_methods(project),
        *find_opmodes_never_run(project),
        *find_foreign_paths(project),
        *find_misplaced_physics(project),
    ]
