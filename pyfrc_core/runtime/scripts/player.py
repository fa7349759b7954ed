"""Plays an input script into a run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ...errors import PyfrcError
from ...hal.kinds import UnknownKey
from ...wpi import robots
from ..clock import INPUT, MEASURED, PACKET_US, to_us
from ..robot import RobotRun
from .network_targets import NETWORK
from .script import InputScript, ScriptError, Step
from .sensors import HOLD
from .targets import MATCH_TIME, Targets

#: The shortest period of physics, in microseconds.
_SHORTEST_US = 10_000


class Player:
    """Writes what a script says, when it says so.

    :raises ScriptError: when the script names something that there never is, with its line
    """

    def __init__(self, script: InputScript, run: RobotRun) -> None:
        self._script = script
        self._run = run
        self._targets = Targets(run.hal_data, run.connection.packet, run.when_network_written)
        run.at_close(self._targets.close)
        self._steps = iter(script.steps)
        self._next = next(self._steps, None)
        for step in script.steps:
            with self._naming_the_line_of(step):
                for target in step.writes:
                    self._targets.check(target)

    def play(self, until_us: int | None = None) -> None:
        """Start the robot, which has been constructed, and run it to the script's end.

        :param until_us: an earlier end
        :raises ScriptError: when something cannot be written, or the robot has no such device
        """
        __tracebackhide__ = True
        self.start()
        end_us = self._script.end_us if until_us is None else min(until_us, self._script.end_us)
        if end_us > self._run.clock.now_us:
            self._run.run_until(end_us - 1)
        if end_us == self._script.end_us:
            self.see_that_all_were_there()

    def start(self) -> None:
        """Start the robot; from then on the clock writes what is due."""
        __tracebackhide__ = True
        run, script = self._run, self._script
        run.clock.limit_us = max(run.clock.limit_us, script.end_us)
        if any(MATCH_TIME in step.writes for step in script.steps):
            run.clock.before_packet.append(self._on_packet)
        held = {target for step in script.steps for target in step.writes if target.startswith(HOLD)}
        if any(target.startswith(HOLD + NETWORK) for target in held):
            self._targets.held.replace_simulation()
        if held:
            run.clock.every(self._physics_us, MEASURED, self._targets.held.apply)
            self._targets.held.ahead = script.steps
            run.when_simulated.append(lambda: self._targets.held.hold_in_loop(run.clock.now_us))
        if script.start_us > run.clock.now_us:
            run.run_until(script.start_us)
        self._write_until(script.start_us)
        run.start()

    @property
    def _physics_us(self) -> int:
        """The period in which physics writes, in microseconds, at most."""
        period_us = to_us(robots.period(self._run.robot, PACKET_US / 1_000_000))
        return min(PACKET_US, max(_SHORTEST_US, period_us))

    def _on_packet(self, now: float) -> None:
        self._targets.count_down(self._run.clock.now_us)

    def _write_until(self, now_us: int) -> None:
        while self._next is not None and self._next.at_us <= now_us:
            step, self._next = self._next, next(self._steps, None)
            with self._naming_the_line_of(step):
                for target, value in step.writes.items():
                    self._targets.write(target, value, now_us)
        if self._next is not None:
            self._run.clock.at(self._next.at_us, INPUT, lambda: self._write_until(self._run.clock.now_us))

    def see_that_all_were_there(self) -> None:
        """Check, at the end, for writes to devices that the robot has not made, which have no effect.

        :raises ScriptError: naming the first such line
        """
        for step in self._script.steps:
            with self._naming_the_line_of(step):
                for target in step.writes:
                    self._targets.check_made(target)

    @contextmanager
    def _naming_the_line_of(self, step: Step) -> Iterator[None]:
        try:
            yield
        except (PyfrcError, TypeError, ValueError) as wrong:
            if isinstance(wrong, ScriptError):
                raise
            message = wrong.message if isinstance(wrong, PyfrcError) else str(wrong)
            if isinstance(wrong, PyfrcError) and wrong.where and not isinstance(wrong, UnknownKey):  # the target
                message = f"{wrong.where}: {message}"
            remedy = wrong.remedy if isinstance(wrong, PyfrcError) else None
            where = f"{self._script.file}:{step.line}" if step.line else self._script.file
            raise ScriptError(message, where=where, remedy=remedy) from None
