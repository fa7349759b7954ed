"""Removing programs in Java and C++ from a robot, with their libraries: they take disk space and memory.

It is done by the robot's shell as the administrator, since a robot that had such a program may have no Python.
"""

from __future__ import annotations

from shlex import quote

from .agent.inventory import LIBRARIES, PROGRAMS, START_COMMAND, START_COMMAND_FILES
from .connection import ADMINISTRATOR, Connection
from .errors import DeployError, RefusedError

#: What is removed, for the question and the docs.
WHAT = "Java's and C++'s robot programs, their libraries, Java itself, and /home/lvuser/deploy"

# Prints a line for each thing that it removes. A program in Python runs on, and its start command stays.
_REMOVE = f"""
for paths in frc-path.sh natinst-path.sh; do
    [ ! -r /etc/profile.d/$paths ] || . /etc/profile.d/$paths
done
for command in {" ".join(START_COMMAND_FILES)}; do
    if grep -qE {quote(START_COMMAND)} $command 2> /dev/null; then
        rm -f $command || exit 1
        echo "$command"
        stop=yes
    fi
done
[ -z "$stop" ] || /usr/local/frc/bin/frcKillRobot.sh -t > /dev/null 2>&1
for path in {" ".join(PROGRAMS)} /home/lvuser/deploy {LIBRARIES}; do
    if [ -e "$path" ]; then
        rm -rf "$path" || exit 1
        echo "$path"
    fi
done
packages=$(opkg list-installed 'frc*-openjdk-*')
if [ -n "$packages" ]; then
    opkg remove 'frc*-openjdk*' > /dev/null || exit 1
    echo "$packages"
fi
sync
"""


def remove_other_languages(connection: Connection) -> list[str]:
    """Remove them; return what was removed, a line for each path or package.

    :raises RefusedError: when it is a virtual robot
    :raises DeployError: when something could not be removed
    """
    if connection.is_virtual_robot:
        raise RefusedError(
            "a virtual robot runs programs in Python only: there is nothing to remove",
            where=str(connection.address),
            remedy="To remove its program in Python: pyfrc undeploy",
        )
    with connection.as_user(ADMINISTRATOR) as administrator:
        status, printed = administrator.run(_REMOVE)
    if status != 0:
        raise DeployError(
            f"not all of it could be removed: {printed.strip() or f'exit code {status}'}",
            where=str(connection.address),
            remedy="Run the command again, or image the robot.",
        )
    return printed.splitlines()
