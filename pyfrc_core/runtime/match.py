"""A whole match, as the field runs it: disabled, autonomous, a pause, teleoperated."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..config.settings import MatchSettings
from .robot_time import to_us

if TYPE_CHECKING:
    from ..wpi import station


class MatchPeriods:
    """When each period of a match begins and ends."""

    def __init__(self, settings: MatchSettings) -> None:
        self._autonomous_from = to_us(settings.before)
        self._autonomous_until = self._autonomous_from + to_us(settings.autonomous)
        self._teleop_from = self._autonomous_until + to_us(settings.pause)
        #: How long it all takes, in microseconds.
        self.length_us = self._teleop_from + to_us(settings.teleop)

    def is_before_autonomous(self, since_us: int) -> bool:
        """Return whether the match has begun and autonomous has not."""
        return since_us < self._autonomous_from

    def at(self, since_us: int) -> tuple[station.Mode, float] | None:
        """The mode so long after the match began, and the seconds left in it; None when it is over."""
        if since_us >= self.length_us:
            return None
        if since_us >= self._teleop_from:
            return "teleop", (self.length_us - since_us) / 1_000_000
        if self._autonomous_from <= since_us < self._autonomous_until:
            return "autonomous", (self._autonomous_until - since_us) / 1_000_000
        return "disabled", 0.0
