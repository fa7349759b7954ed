"""Tests that run any robot through its modes."""

from pyfrc_core.tests.basic import test_autonomous, test_disabled, test_operator_control, test_practice

__all__ = ["test_autonomous", "test_disabled", "test_operator_control", "test_practice"]
