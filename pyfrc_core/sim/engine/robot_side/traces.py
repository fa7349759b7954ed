"""What the robot does, packet by packet, until it is reported: the lines of `hal_data` and of NetworkTables."""

from __future__ import annotations

from typing import Any

from ....runtime.scripts.trace import Trace
from .network_trace import NetworkTrace


class _Lines(list[str]):
    """A file for a trace's lines."""

    def write(self, lines: str) -> None:
        self += [f"{line}\n" for line in lines.split("\n")[:-1]]


class Traces:
    """Both traces.

    :param network: None: NetworkTables are not reported
    """

    def __init__(self, hal_data: Any, network: NetworkTrace | None) -> None:
        self._lines = _Lines()
        self._trace = Trace(hal_data, self._lines)  # type: ignore[arg-type]
        self._lines.clear()  # its header
        self._network = network
        #: False in a replay that does the same as the run before: its lines are known.
        self.is_on = False

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        self.look_at_hal(now)
        if self._network is not None:
            self._network.look(now)

    def look_at_hal(self, now: float) -> None:
        """Note what has changed of `hal_data`."""
        self._trace.look(now)

    def skip(self, now: float) -> None:
        """Take over what NetworkTables show, where it is known."""
        if self._network is not None and not self.is_on:
            self._network.skip(now)

    def skip_hal(self, now: float) -> None:
        """Take over what `hal_data` shows, where it is known: only what changes from now on is noted."""
        if not self.is_on:
            self._trace.look(now)
            self._trace.write_lines()
            self._lines.clear()

    def take(self) -> tuple[str, ...]:
        """Return the new lines of `hal_data`."""
        self._trace.write_lines()
        lines = tuple(self._lines)
        self._lines.clear()
        return lines

    def take_network(self, now: float, is_base: bool = False) -> tuple[dict[str, Any], tuple[str, ...]]:
        """Return all values of NetworkTables, where the report is a base, and the new lines."""
        return ({}, ()) if self._network is None else self._network.report(now, is_base, not self.is_on)
