"""Ready-made tests for any robot: put ``from pyfrc.tests import *`` in a file in your tests directory."""

from .basic import test_autonomous, test_disabled, test_operator_control, test_practice
from .fuzz_test import test_fuzz

__all__ = ["test_autonomous", "test_disabled", "test_fuzz", "test_operator_control", "test_practice"]
