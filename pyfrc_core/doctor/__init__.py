"""What `pyfrc doctor` looks at: this computer's Python and packages, its screen, the robot project, the robot.

It looks without importing anything that may be broken: what is installed says so itself, and what is to be imported is
imported in a process apart.
"""

from .examine import Examination, examine
from .findings import Finding

__all__ = ["Examination", "Finding", "examine"]
