"""All checks of the robot code that is imported for mistakes that raise no error here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .code_warning import CodeWarning
from .enum_values import find_early_reads, find_wrong_comparisons
from .foreign_paths import find_foreign_paths
from .kinds import Kinds
from .lost_commands import find_lost_commands
from .misplaced_physics import find_misplaced_physics
from .misspelled_methods import find_misspelled_methods
from .never_used import find_never_used
from .no_effect import find_lines_without_effect
from .opmodes_never_run import find_opmodes_never_run
from .setting_names import find_misspelled_settings
from .sources import sources
from .wrong_moments import find_wrong_moments
from .wrong_tests import find_wrong_tests
from .wrong_units import find_wrong_units

if TYPE_CHECKING:
    from ...project import Project


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
        *find_lost_commands(kinds),
        *find_wrong_moments(kinds),
        *find_wrong_units(kinds),
        *find_wrong_tests(kinds),
        *find_wrong_comparisons(files),
        *find_early_reads(robots),
        *find_misspelled_settings(project),
    ]
