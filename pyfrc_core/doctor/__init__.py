"""The checks of `pyfrc doctor`: this computer's Python, packages and display, the robot project, the robot.

Modules that may be broken are not imported in this process: packages are checked by their metadata, and imports are
tested in a separate process.
"""

from .check_result import CheckResult
from .examine import DoctorOptions, examine

__all__ = ["CheckResult", "DoctorOptions", "examine"]
