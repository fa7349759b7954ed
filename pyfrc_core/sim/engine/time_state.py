"""Whether robot time goes on, how far and how fast: what the user's commands make of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ...runtime.robot_time import PACKET_US
from .commands import Command, Pause, Run, Speed


@dataclass(frozen=True)
class TimeState:
    """Changed by commands, and by reaching `until_us`; by nothing else.

    The robot's process goes by it. The `Simulation` computes from it what the user wants, whatever the process is at.

    :param until_us: pause when robot time gets there; None: never
    :param stepping: whether `until_us` is the end of a step, counted from where it began
    :param speed: robot seconds a second; 0 is as fast as it goes
    """

    paused: bool = False
    until_us: int | None = None
    stepping: bool = False
    speed: float = 1.0

    def after(self, command: Command, next_packet_us: int) -> TimeState:
        """Return the state after a command, which need not be one about time.

        A step that comes before the end of another one is added to it: how fast the machine is makes no difference.

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
        """Return the state when time stands still, by `Pause` or at `until_us`."""
        return replace(self, paused=True, until_us=None, stepping=False)

    def continued_at(self, time_us: int) -> TimeState:
        """Return the state after going to another moment: a step ends there; a later `until_us` stays."""
        if self.paused or self.stepping or (self.until_us is not None and self.until_us <= time_us):
            return self.stopped()
        return self
