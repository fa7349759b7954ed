"""The state of robot time that the user wants: running or paused, how far, how fast."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ...runtime.robot_time import PACKET_US
from .commands import Command, Pause, Run, Speed


@dataclass(frozen=True)
class TimeState:
    """Changes by commands and by reaching `until_us` only.

    The robot's process follows it. The `Simulation` computes from it what the user wants, however far the process is.

    :param until_us: pause when robot time gets there; None: never
    :param stepping: whether `until_us` is the end of a step
    :param speed: robot seconds per second; 0 is as fast as possible
    """

    paused: bool = False
    until_us: int | None = None
    stepping: bool = False
    speed: float = 1.0

    def after(self, command: Command, next_packet_us: int) -> TimeState:
        """Return the state after a command, which need not be one about time.

        A step that comes before the end of another is added to it, so that the machine's speed makes no difference.

        :param next_packet_us: when the first packet after the command is due
        """
        match command:
            case Run(packets=int(packets)):
                begin_us = self.until_us if self.stepping and self.until_us is not None else next_packet_us - PACKET_US
                return replace(self, paused=False, until_us=begin_us + packets * PACKET_US, stepping=True)
            case Run():
                return replace(self, paused=False, until_us=command.until_us, stepping=False)
            case Pause():
                return self.stopped()
            case Speed():
                return replace(self, speed=command.factor)
            case _:
                return self

    def stopped(self) -> TimeState:
        """Return the paused state, after `Pause` or at `until_us`."""
        return replace(self, paused=True, until_us=None, stepping=False)

    def continued_at(self, time_us: int) -> TimeState:
        """Return the state after going to another moment. It ends a step; a later `until_us` stays."""
        if self.paused or self.stepping or (self.until_us is not None and self.until_us <= time_us):
            return self.stopped()
        return self
