"""The robot project of a command: where its robot.py is, which files belong to it, and its settings.

In: a directory, and options that name a file or class. Out: a `Project`. Which files are the project's decides much
elsewhere: they get robot time, and their lines come first in a failure (`robot_files`). `walk` is the one way through a
project's files. Imports no WPILib, so that commands find mistakes before they start a robot: `runtime.loading` imports
the robot's code.
"""

from .locate import find_project, projects_below
from .project import MAIN_FILE, NO_PHYSICS, TEST_FILES, Project

__all__ = ["MAIN_FILE", "NO_PHYSICS", "TEST_FILES", "Project", "find_project", "projects_below"]
