"""Removing programs in Java and C++ and their libraries from a robot, to free disk space and memory.

This runs shell commands as administrator, since a robot that had such a program may not have Python.
"""

from __future__ import annotations

from .connection import Connection
from .errors import DeployError, RefusedError


def remove_other_languages(connection: Connection) -> list[str]:
    """Remove the programs. Return the removed paths and packages.

    :raises RefusedError: if the robot is a virtual robot
    :raises DeployError: if the removal fails
    """
    if connection.is_virtual_robot:
        raise RefusedError(
            "a virtual robot runs only programs in Python: there is nothing to remove",
            where=str(connection.address),
            remedy="To remove its program in Python: pyfrc undeploy",
        )
    controller = connection.controller
    with connection.as_user(controller.layout.administrator) as administrator:
        status, printed = administrator.run(controller.remove_leftovers)
    if status != 0:
        raise DeployError(
            f"not everything could be removed: {printed.strip() or f'exit code {status}'}",
            where=str(connection.address),
            remedy="Run the command again, or image the robot.",
        )
    return printed.splitlines()
