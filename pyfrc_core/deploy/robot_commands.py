"""Command lines that messages suggest: about the same robot as the command that the user typed.

A suggestion such as ``pyfrc deploy --rollback`` that leaves out ``--robot HOST`` would look for the team's robot, which
may be another one. So the address is added here, to each message of a command, and not where the messages are written.
"""

from __future__ import annotations

import re
import shlex

#: A suggested command about a robot that does not name one yet.
_COMMAND = re.compile(r"\bpyfrc (?:deploy-info|deploy|undeploy|console|doctor)\b(?!-)(?! --(?:robot|team)\b)")


def naming_robot(text: str, robot: str | None, team: int | None) -> str:
    """Return a message with the robot named in each command line that it suggests.

    :param text: the message, with commands such as ``pyfrc deploy --rollback``
    :param robot: the address that was typed, as ``HOST`` or ``HOST:PORT``
    :param team: the team's number that was typed; with neither, the text stays as it is
    """
    if robot is not None:
        options = f"--robot {shlex.quote(robot)}"
    elif team is not None:
        options = f"--team {team}"
    else:
        return text
    return _COMMAND.sub(lambda found: f"{found[0]} {options}", text)
