"""NetworkTables and the command scheduler."""

from __future__ import annotations

from collections.abc import Iterator

from ...wpi import commands, dashboards, network
from .part import Part


class Commands(Part):
    """The command scheduler: the next run gets a new one."""

    def restore(self) -> None:
        commands.forget_all()

    def left_over(self) -> Iterator[str]:
        yield from (f"the command {name}" for name in commands.names_of_scheduled())
        commands.forget_all()  # to ask for it has made the next scheduler


class Tables(Part):
    """The entries of the robot's tables."""

    def __init__(self) -> None:
        network.start()  # its thread, which lives as long as the process, is there from now on
        network.stop()

    def restore(self) -> None:
        dashboards.forget_shown()
        network.forget_entries()

    def left_over(self) -> Iterator[str]:
        for name in network.entry_names():
            if not name.startswith(network.OF_WPILIB):
                yield f"the entry {name} of NetworkTables"
