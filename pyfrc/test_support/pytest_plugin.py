"""The pytest plugin with the fixtures for robot tests."""

from pyfrc_core.test_support.pytest_plugin import PyFrcPlugin, ThreadStillRunningError

__all__ = ["PyFrcPlugin", "ThreadStillRunningError"]
