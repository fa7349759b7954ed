"""A whole match, as the field runs it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..config.settings import MatchSettings
from ..hal import modes
from ..runtime.clock import to_us

if TYPE_CHECKING:
    from .controller import TestController


class PracticeMatch:
    """Disabled, autonomous, a pause, teleoperated, the end; with the match time that the robot can ask for."""

    def __init__(self, control: TestController, settings: MatchSettings) -> None:
        self._control = control
        self._mode: modes.Mode | None = None
        self._autonomous_from = to_us(settings.before)
        self._autonomous_until = self._autonomous_from + to_us(settings.autonomous)
        self._teleop_from = self._autonomous_until + to_us(settings.pause)
        self._teleop_until = self._teleop_from + to_us(settings.teleop)

    def on_step(self, now: float) -> bool:
        """Put the robot into the mode of this moment; answers whether the match still goes on."""
        now_us = to_us(now)
        if now_us >= self._teleop_until:
            return False
        if now_us >= self._teleop_from:
            self._enter("teleop", self._teleop_until - now_us)
        elif now_us >= self._autonomous_until:
            self._enter("disabled", 0)
        elif now_us >= self._autonomous_from:
            self._enter("autonomous", self._autonomous_until - now_us)
        else:
            self._enter("disabled", 0)
        return True

    def _enter(self, mode: modes.Mode, left_us: int) -> None:
        if mode != self._mode:
            self._mode = mode
            if mode == "autonomous":
                self._control.set_autonomous()
            else:
                self._control.set_operator_control(enabled=mode == "teleop")
        modes.set_match_time(left_us / 1_000_000)
