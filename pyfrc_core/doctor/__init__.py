"""The checks of `pyfrc doctor`: this computer's Python, packages and display, the robot project, the robot.

In: a directory. Out: results as data, which the command prints. Modules that may be broken are not imported in this
process: packages are checked by their metadata, and imports are tested in a separate process, one after the other, so
that a library that crashes Python is known by its name. The robot is searched meanwhile; its problems are those that a
deploy would refuse. The last result is the next step from a blank controller to a driving robot.
"""

from .check_result import CheckResult
from .examine import DoctorOptions, examine
from .steps import NEXT_STEP

__all__ = ["NEXT_STEP", "CheckResult", "DoctorOptions", "examine"]
