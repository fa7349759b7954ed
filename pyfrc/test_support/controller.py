"""Control the robot's state during a test."""

from pyfrc_core.test_support.controller import TestController

__all__ = ["TestController"]
