"""Removing programs in Java and C++ and their libraries from a robot, to free disk space and memory.

This runs shell commands as administrator, since a robot that had such a program may not have Python.
"""

from __future__ import annotations

from shlex import quote

from .agent.inventory import LIBRARIES, PROGRAMS, START_COMMAND, START_COMMAND_FILES
from .connection import ADMINISTRATOR, Connection
from .errors import DeployError, RefusedError

#: A description of what is removed.
WHAT = "Java's and C++'s robot programs, their libraries, Java itself, and /home/lvuser/deploy"

# Prints a line for each removed path or package. A program in Python keeps running, with its start command.
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
    with connection.as_user(ADMINISTRATOR) as administrator:
        status, printed = administrator.run(_REMOVE)
    if status != 0:
        raise DeployError(
            f"not everything could be removed: {printed.strip() or f'exit code {status}'}",
            where=str(connection.address),
            remedy="Run the command again, or image the robot.",
        )
    return printed.splitlines()
