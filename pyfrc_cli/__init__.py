"""The `pyfrc` command: parses, calls one function of the core, prints.

PYTEST_DONT_REWRITE
"""
