"""A test of the robot with random inputs."""

from pyfrc_core.tests.fuzz_test import test_fuzz

__all__ = ["test_fuzz"]
