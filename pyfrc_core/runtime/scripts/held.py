"""What a log measured is there for the robot, in place of what physics makes (`sensors`).

A write to such a target is there after the physics of its packet, and again after that of each later packet, until
null is written: physics does not change what a log has. A device that the robot does not have is left out.

What a camera measured is published once, with the time of the write, after the physics of that packet or the next one.
What simulation code publishes there itself is left out: a subscriber would get both.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ...compat.cpython_private import get_frame
from ...errors import PyfrcError
from ...wpi import network_writes
from ..patch_table import PatchTable
from ..simulation_code import is_of_simulation
from .network_entries import NetworkEntries
from .network_targets import NETWORK, parse_entry_target
from .sensors import HOLD, INFINITE

if TYPE_CHECKING:
    from ...hal import HalData


class Held:
    """The values that are held in one run.

    :param entries: writes those of NetworkTables
    """

    def __init__(self, hal_data: HalData, entries: NetworkEntries) -> None:
        self._hal_data, self._entries = hal_data, entries
        self._values: dict[str, Any] = {}
        #: Where `hal_data` has them.
        self._places: dict[str, tuple[Any, Any]] = {}
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
            self._values[path] = math.inf if value == INFINITE else value

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
            except (PyfrcError, LookupError):  # the robot does not have it, or not yet
                continue
        news, self._news = self._news, []
        for target, value, at_us in news:
            self._entries.write(target, value, at_us)

    def replace_simulation(self) -> None:
        """Leave out what simulation code publishes under a name that is held, until `close`."""
        for patch in list(network_writes.replacements(self._may_write)):
            self._replaced.patch(*patch)

    def close(self) -> None:
        """Leave nothing to later runs in this process."""
        self._replaced.undo()

    def _may_write(self, name: str) -> bool:
        return name not in self._names or not is_of_simulation(get_frame(1))
