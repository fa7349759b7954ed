"""Generate a dashboard's inputs: find in NetworkTables what drivers may select, type and click, and change it."""

from __future__ import annotations

import random
from collections.abc import Iterator

import ntcore

from ..runtime.clock import PACKET_US
from ..runtime.scripts.targets import NETWORK
from .inputs import Input
from .values import Value, draw

_DASHBOARD_TABLES = ("/SmartDashboard/", "/Shuffleboard/")

#: Seconds from one choice to the next, on average.
_PAUSE = 3.0


def find_dashboard() -> Iterator[Input]:
    """Return the choosers' options, the commands' buttons, and plain entries."""
    network = ntcore.NetworkTableInstance.getDefault()
    for topic in network.getTopics():
        name = topic.getName()
        table, _, entry = name.rpartition("/")
        if not name.startswith(_DASHBOARD_TABLES) or entry.startswith("."):
            continue
        sort, made_by = topic.getType(), network.getEntry(f"{table}/.type").getString("")
        if made_by == "String Chooser":
            if entry == "options" and (options := network.getEntry(name).getStringArray([])):
                yield Input(f"{NETWORK}{table}/selected", "choice", table, tuple(options))
        elif made_by == "Command":
            if entry == "running":
                yield Input(NETWORK + name, "command", table)
        elif sort == ntcore.NetworkTableType.kBoolean:
            yield Input(NETWORK + name, "flag", name)
        elif sort == ntcore.NetworkTableType.kDouble:
            yield Input(NETWORK + name, "number", name)


class DashboardGenerator:
    """Generates one match's dashboard inputs."""

    def __init__(self, rng: random.Random) -> None:
        self._rng = rng
        self.next_us = 0
        self._inputs: list[Input] = []
        self._numbers: dict[str, float] = {}
        self._chosen: set[str] = set()

    def set_inputs(self, inputs: list[Input]) -> None:
        """Set the inputs to generate values for."""
        self._inputs = inputs
        for each in inputs:
            if each.kind == "number" and each.target not in self._numbers:
                entry = ntcore.NetworkTableInstance.getDefault().getEntry(each.target.removeprefix(NETWORK))
                self._numbers[each.target] = entry.getDouble(0.0)

    def write(self, now_us: int, found: dict[str, Value]) -> None:
        """Add the writes of this time: a choice for each new chooser, and a random change now and then."""
        rng = self._rng
        for each in self._inputs:
            if each.kind == "choice" and each.target not in self._chosen:
                self._chosen.add(each.target)
                self._choose(each, found)
        if self._inputs and self.next_us:
            self._choose(rng.choice(self._inputs), found)
        self.next_us = now_us + PACKET_US + round(rng.expovariate(1 / _PAUSE) * 50) * PACKET_US

    def _choose(self, each: Input, found: dict[str, Value]) -> None:
        found[each.target] = draw(each.kind, self._rng, each.options, self._numbers.get(each.target, 0.0))
