"""Adds the user's robot options to command lines in messages.

A message may suggest ``pyfrc deploy --rollback``. Without ``--robot HOST``, this command would use the team's robot,
which may be another one. So the option is added here, in one place, to all messages of a command.
"""

from __future__ import annotations

import re
import shlex

#: A command about a robot without an option that selects the robot.
_COMMAND = re.compile(r"\bpyfrc (?:deploy-info|deploy|undeploy|console|doctor)\b(?!-)(?! --(?:robot|team)\b)")


def with_robot_option(text: str, robot: str | None, team: int | None) -> str:
    """Return a message with the robot's option added to each command line in it.

    :param text: the message, with commands such as ``pyfrc deploy --rollback``
    :param robot: the address from the command line, as ``HOST`` or ``HOST:PORT``
    :param team: the team number from the command line; without both, the text stays unchanged
    """
    if robot is not None:
        options = f"--robot {shlex.quote(robot)}"
    elif team is not None:
        options = f"--team {team}"
    else:
        return text
    return _COMMAND.sub(lambda found: f"{found[0]} {options}", text)
