"""A test that all of your robot code has docstrings."""

from pyfrc_core.tests.docstring_test import ignore_object, test_docstrings

__all__ = ["ignore_object", "test_docstrings"]
