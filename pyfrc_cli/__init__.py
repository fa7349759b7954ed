"""The `pyfrc` command: parses, calls one function of the core, prints.

PYTEST_DONT_REWRITE
"""

#: The environment variable in which a shell asks for completions of a command line; click chooses the name.
COMPLETE_VARIABLE = "_PYFRC_COMPLETE"
