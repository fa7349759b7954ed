"""What a log measured is there for the robot, in place of what physics makes (`sensors`).

A write to such a target is there after the physics of its packet, and again after that of each later packet, until
null is written: physics does not change what a log has. A device that the robot does not have is left out.

Robot code's own simulation runs within the loop: commands read what the `simulationPeriodic` of their subsystem has
just written, which a log has with the next packet. So what it writes becomes the value of that packet.

What a camera measured is published once, with the time of the write, after the physics of that packet or the next one.
What simulation code publishes there itself is left out: a subscriber would get both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from ...compat.cpython_private import get_frame
from ...errors import PyfrcError
from ...patch_table import PatchTable
from ...wpi import network_writes
from ..robot_time import PACKET_US
from ..simulation_code import is_of_simulation
from .network_entries import NetworkEntries
from .network_targets import NETWORK, parse_entry_target
from .script import Step
from .sensors import HOLD, INFINITE

if TYPE_CHECKING:
    from ...hal import HalData


class HeldValues:
    """The values that are held in one run.

    :param entries: writes those of NetworkTables
    """

    def __init__(self, hal_data: HalData, entries: NetworkEntries) -> None:
        self._hal_data, self._entries = hal_data, entries
        self._values: dict[str, Any] = {}
        #: Where `hal_data` has them, and what it has then.
        self._places: dict[str, tuple[Any, Any]] = {}
        self._shown: dict[str, Any] = {}
        #: What is going to be written, and of that, what will be there after the next packet.
        self.ahead: Sequence[Step] = ()
        self._looked_at = 0
        self._next: dict[str, Any] = {}
        #: What is to be published: the target, the value and its time; and the names of all entries that are held.
        self._news: list[tuple[str, Any, int]] = []
        self._names: set[str] = set()
        self._replaced = PatchTable()

    def write(self, target: str, value: object, now_us: int) -> None:
        """Hold a value from the end of this packet on; None leaves it to physics."""
        path = target.removeprefix(HOLD)
        if path.startswith(NETWORK):
            name, _ = parse_entry_target(path)
            if value is None:
                self._names.discard(name)
            else:
                self._names.add(name)
                self._news.append((path, value, now_us))
        elif value is None:
            self._values.pop(path, None)
        else:
            self._values[path] = _measured(value)

    def apply(self) -> None:
        """Write all values, in place of those of physics.

        :raises UsageError: when an entry of NetworkTables cannot have its value
        """
        for path, value in self._values.items():
            try:
                if path not in self._places:
                    self._places[path] = self._hal_data.locate(path)
                place, key = self._places[path]
                place[key] = value
                self._shown[path] = place[key]
            except (PyfrcError, LookupError):  # the robot does not have it, or not yet
                continue
        news, self._news = self._news, []
        for target, value, at_us in news:
            self._entries.write(target, value, at_us)

    def hold_in_loop(self, now_us: int) -> None:
        """Replace what robot code has written since the last packet by what the log has after the next one."""
        until_us = -(-now_us // PACKET_US) * PACKET_US
        while self._looked_at < len(self.ahead) and self.ahead[self._looked_at].at_us <= until_us:
            self._next |= self.ahead[self._looked_at].writes
            self._looked_at += 1
        for path, shown in self._shown.items():
            place, key = self._places[path]
            value = self._next.get(HOLD + path)
            with suppress(PyfrcError, LookupError):  # the robot has it no longer
                if value is not None and path in self._values and place[key] != shown:
                    place[key] = _measured(value)

    def replace_simulation(self) -> None:
        """Leave out what simulation code publishes under a name that is held, until `close`."""
        for patch in list(network_writes.replacements(self._may_write)):
            self._replaced.patch(*patch)

    def close(self) -> None:
        """Leave nothing to later runs in this process."""
        self._replaced.undo()

    def _may_write(self, name: str) -> bool:
        return name not in self._names or not is_of_simulation(get_frame(1))


def _measured(value: Any) -> Any:
    return math.inf if value == INFINITE else value
