"""Mashes the buttons and switches in random ways."""

from pyfrc_core.tests.fuzz_test import test_fuzz

__all__ = ["test_fuzz"]
