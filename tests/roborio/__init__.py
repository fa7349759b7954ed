"""A roboRIO look-alike: a real OpenSSH server in a root of its own, with a robot's users, paths and programs.

``python -m tests.roborio``, as root on Linux, starts one to try `pyfrc deploy` on without a robot.
"""

from .machine import PATIENCE, Roborio, missing_here, python_package, require_roborio
from .proxy import Proxy

__all__ = ["PATIENCE", "Proxy", "Roborio", "missing_here", "python_package", "require_roborio"]
