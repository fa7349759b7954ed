"""Run the robot through its modes and find out whether its code crashes."""

from pyfrc.tests import *  # noqa: F403
