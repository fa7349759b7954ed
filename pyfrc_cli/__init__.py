"""The `pyfrc` command: the only room that knows the command line.

Each command is a module: it parses its arguments, calls one function of the core, and prints. `start` is the entry
point, `main` the table of commands. `main` imports a command's module only when the command is used, and the module
imports what is heavy inside its function, so that `pyfrc --help` needs neither WPILib nor pytest.

`robotpy` finds pyfrc's commands through `robotpy_plugins`. It has imported WPILib by then, which is too late for a
fixed hash seed and for robot time, so a new interpreter runs the same command.

PYTEST_DONT_REWRITE
"""
