"""What guides a campaign: goals, which a match may be the first to reach.

Goals are tuples of text and numbers, so that they can be written to a file. A line is a file, relative to the project,
and a number. The others begin with the name of their kind.
"""

from __future__ import annotations

#: A file, relative to the project, and the number of a line.
RobotLine = tuple[str, int]

Goal = tuple[str | int, ...]

#: Kinds of goals.
LINE, BRANCH, STATE = "line", "branch", "state"


def kind_of(goal: Goal) -> str:
    """Return the kind of a goal."""
    return LINE if len(goal) == 2 else str(goal[0])
