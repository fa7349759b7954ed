"""The tests that come with pyfrc."""

from pyfrc.tests import *  # noqa: F403
