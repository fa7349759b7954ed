"""The robot project of a command: where its robot.py is, which files belong to it, and its settings.

Imports no WPILib: `runtime.loading` imports the robot's code.
"""

from .locate import find_project
from .project import MAIN_FILE, NO_PHYSICS, TEST_FILES, Project

__all__ = ["MAIN_FILE", "NO_PHYSICS", "TEST_FILES", "Project", "find_project"]
