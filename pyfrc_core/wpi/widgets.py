"""What the user of a dashboard can change, in each season. It imports no WPILib."""

from __future__ import annotations

from typing import Literal, NamedTuple


class DashboardControl(NamedTuple):
    """What the user of a dashboard can change of an object that robot code shows.

    :param kind: a choice, the button of a command, a switch, or a number
    :param entry: the entry that the dashboard writes
    :param owner: what it belongs to: the table of the object, or the entry itself
    :param options: what can be chosen
    """

    kind: Literal["choice", "command", "flag", "number"]
    entry: str
    owner: str
    options: tuple[str, ...] = ()
