"""What guides a campaign: goals, which a match may be the first to reach.

Goals are tuples of text and numbers, so that they can be written to a file. A line is a file, relative to the project,
and a number. The others begin with the name of their kind.
"""

from __future__ import annotations

from collections.abc import Iterable

#: A file, relative to the project, and the number of a line.
RobotLine = tuple[str, int]

Goal = tuple[str | int, ...]

#: Kinds of goals.
LINE, BRANCH, STATE = "line", "branch", "state"


def kind_of(goal: Goal) -> str:
    """Return the kind of a goal."""
    return LINE if len(goal) == 2 else str(goal[0])


def share(reached: Iterable[Goal], all_lines: frozenset[RobotLine]) -> float:
    """Return the share of the lines that was reached, from 0 to 1."""
    return len(all_lines.intersection(reached)) / len(all_lines) if all_lines else 1.0
