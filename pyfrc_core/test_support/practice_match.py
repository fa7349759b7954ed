"""A whole match in a test, with the match time that the robot can ask for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..config.settings import MatchSettings
from ..hal import modes
from ..runtime.clock import to_us
from ..runtime.match import MatchPeriods

if TYPE_CHECKING:
    from .controller import TestController


class PracticeMatch:
    """Puts the robot through a match."""

    def __init__(self, control: TestController, settings: MatchSettings) -> None:
        self._control = control
        self._mode: modes.Mode | None = None
        self._periods = MatchPeriods(settings)

    def on_step(self, now: float) -> bool:
        """Put the robot into the mode of this moment; answers whether the match still goes on."""
        period = self._periods.at(to_us(now))
        if period is None:
            return False
        mode, left = period
        if mode != self._mode:
            self._mode = mode
            if mode == "autonomous":
                self._control.set_autonomous()
            else:
                self._control.set_operator_control(enabled=mode == "teleop")
        modes.set_match_time(left)
        return True
