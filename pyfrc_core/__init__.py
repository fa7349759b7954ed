"""The core library of pyfrc: everything that the commands and the documented import names are made of.

PYTEST_DONT_REWRITE: pytest loads a plugin from here, and must not compile the rest again for that.
"""
