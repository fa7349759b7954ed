"""Generate a network's inputs: what drivers select, type and click in a dashboard, and what cameras send."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ...runtime.clock import PACKET_US
from ...runtime.scripts.network_targets import NETWORK, entry_target, parse_entry_target
from ...wpi import dashboards, network
from ...wpi import names as robot_names
from .network_values import SEES_TARGET, NetworkRead, NetworkValues, is_setting
from .values import UNKNOWN, Input, RobotConstants, Value, draw

#: Seconds from one choice to the next, on average and at least; each entry that the robot reads makes them more.
_PAUSE, _SHORTEST_PAUSE = 3.0, 0.3

#: The share of the entries that nothing is known to read, such as the telemetry of a dashboard.
_UNREAD = 0.15

#: How often an entry has a value when the robot starts.
_BEFORE_START = 0.5

#: How often a dashboard publishes an entry of another type than the robot reads.
_OTHER_TYPE = 0.06

#: Types whose values show them, so that a target does not name them.
_PLAIN = ("boolean", "double", "string")
_NUMBERS = ("int", "float", "double")


def find_dashboard_inputs() -> list[Input]:
    """Return the choosers' options, the commands' buttons, and what else belongs to an object, in order.

    A plain entry that the robot writes and does not read is no input.
    """
    widgets = filter(None, map(dashboards.widget_of, network.entry_names()))
    return sorted(Input(NETWORK + each.entry, each.kind, each.owner, each.options) for each in widgets)


class DashboardGenerator:
    """Generates one match's inputs from the network.

    :param reads: the entries that the robot reads, by name; they may become more; None if they are not watched
    :param published: entries that the program is known to write all the time
    """

    def __init__(
        self,
        rng: random.Random,
        reads: Mapping[str, NetworkRead] | None = None,
        constants: RobotConstants = UNKNOWN,
        published: frozenset[str] = frozenset(),
    ) -> None:
        self._rng = rng
        self._reads = reads
        self._values = NetworkValues(rng, constants)
        self.next_us = 0
        self._inputs: list[Input] = []
        self._unread: list[Input] = []
        #: The value of each number and entry before it was first written.
        self._originals: dict[str, Any] = {}
        self._settings: set[str] = set()
        self._written: dict[str, Value] = {}
        self._chosen: set[str] = set()
        #: Entries that the program writes itself, and the last values of the others.
        self._published = set(published)
        self._seen: dict[str, object] = {}

    def set_inputs(self, inputs: list[Input]) -> list[Input]:
        """Set the inputs to generate values for; return them with the entries that the robot reads."""
        reads = self._reads or {}
        for read in reads.values():
            self._find_published(read)
        entries = [each for read in reads.values() if (each := self._entry(read)) is not None]
        others = [each for each in inputs if each.target.removeprefix(NETWORK) not in reads]
        plain = [each for each in others if each.kind in ("flag", "number")] if self._reads is not None else []
        self._inputs = [*(each for each in others if each not in plain), *entries]
        self._unread = plain
        for each in inputs:
            if each.kind == "number" and each.target not in self._originals:
                self._originals[each.target] = network.number_of(each.target.removeprefix(NETWORK))
        return [*inputs, *entries]

    def before_first_read(self, read: NetworkRead) -> dict[str, Value]:
        """Return what to write before the robot, which is starting, reads an entry for the first time."""
        if network.exists(read.name) or self._rng.random() >= _BEFORE_START:
            return {}
        found: dict[str, Value] = {}
        entry = self._entry(read)
        if entry is None:
            return found
        if read.type_name in _PLAIN and self._rng.random() < _OTHER_TYPE:  # a dashboard publishes it first
            text = self._rng.choice(("", "0", "true")) if read.type_name != "string" else 0.0
            return {entry_target(read.name): text}
        self._change_entry(entry.target, read, found)
        return found

    def _find_published(self, read: NetworkRead) -> None:
        """Notice an entry whose value changes without a write: the program writes it."""
        if read.name in self._published or read.type_name not in _PLAIN:
            return
        now = network.value_of(read.name)
        known = self._written.get(read.name, self._seen.get(read.name, now))
        if known is not None and now != known:
            self._published.add(read.name)
        self._seen[read.name] = now

    def write(self, now_us: int, found: dict[str, Value]) -> None:
        """Add the writes of this time: a choice for each new chooser, and a random change now and then."""
        rng = self._rng
        for each in self._inputs:
            if each.kind == "choice" and each.target not in self._chosen:
                self._chosen.add(each.target)
                self._choose(each, found)
        if self.next_us:
            if self._unread and (not self._inputs or rng.random() < _UNREAD):
                self._choose(rng.choice(self._unread), found)
            elif self._inputs:
                self._choose(rng.choice(self._inputs), found)
        read = sum(each.kind == "entry" for each in self._inputs)
        pause = max(_SHORTEST_PAUSE, _PAUSE / (1 + read))
        self.next_us = now_us + PACKET_US + round(rng.expovariate(1 / pause) * 50) * PACKET_US

    def _choose(self, each: Input, found: dict[str, Value]) -> None:
        if each.kind != "entry" or self._reads is None:
            found[each.target] = draw(each.kind, self._rng, each.options, self._originals.get(each.target, 0.0))
            return
        camera = [other for other in self._inputs if other.kind == "entry" and other.device == each.device]
        sees = next((other for other in camera if SEES_TARGET.search(_name(other).rpartition("/")[2])), None)
        if sees is None or is_setting(each.device):
            self._change_entry(each.target, self._reads[_name(each)], found)
            return
        # All that a camera measures changes together: without a target, there is nothing to measure.
        target = self._rng.random() < 0.7
        for other in camera:
            read = self._reads[_name(other)]
            if target:
                self._change_entry(other.target, read, found)
            else:
                found[other.target] = self._values.without_target(read)
        if target:
            found[sees.target] = True if self._reads[_name(sees)].type_name == "boolean" else 1

    def _entry(self, read: NetworkRead) -> Input | None:
        """Return the input that an entry is; None if it is none, or not of the type that the robot reads."""
        table, _, last = read.name.rpartition("/")
        if read.name.startswith(robot_names.WRITTEN_BY_WPILIB) or last.startswith(".") or read.name in self._published:
            return None
        type_name, published = read.type_name, network.type_of(read.name)
        if published and published != type_name:
            if not {published, type_name} <= set(_NUMBERS):
                return None
            type_name = published
        return Input(entry_target(read.name, "" if type_name in _PLAIN else type_name), "entry", table)

    def _change_entry(self, target: str, read: NetworkRead, found: dict[str, Value]) -> None:
        if read.name not in self._originals:
            own = network.exists(read.name)
            self._originals[read.name] = network.value_of(read.name) if own else read.default
            if own or is_setting(read.name):
                self._settings.add(read.name)
        now = self._entry(read)
        if now is None or now.target != target:  # the robot has just published it with another type
            return
        setting = read.name in self._settings
        read = replace(read, type_name=parse_entry_target(target)[1] or read.type_name)
        before = self._originals[read.name] if setting else self._written.get(read.name, read.default)
        found[target] = self._written[read.name] = self._values.draw(read, before, setting)


def _name(entry: Input) -> str:
    """Return the full name of an entry."""
    return parse_entry_target(entry.target)[0]
