"""One fuzzed match: apply the generated inputs to a run, and record them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ..errors import PyfrcError
from ..runtime.clock import PACKET_US
from ..runtime.robot import RobotRun
from ..runtime.scripts.boots import PersistentEntry, what_stays, without_entries
from ..runtime.scripts.script import InputScript, Step
from ..runtime.scripts.targets import RESTART, Targets
from .input_generator import InputGenerator
from .journal import Journal
from .values import Value


class FuzzRun:
    """Writes generated inputs to a run.

    :param run: the robot has been constructed, and not started
    :param generator: generates the inputs
    :param journal: where each step is written before it is applied
    """

    def __init__(self, run: RobotRun, generator: InputGenerator, journal: Journal | None = None) -> None:
        self.steps: list[Step] = []
        self._run = run
        self._generator = generator
        self._journal = journal
        #: Whether inputs may be left out that this robot does not have: a recorded match may be another robot's.
        self.may_lack_targets = False
        #: Whether the robot program is started again now: the run ends.
        self.restarts = False
        self._targets = Targets(run.hal_data, run.connection.packet)
        run.at_close(self._targets.close)
        generator.write_at_once = self._apply

    def write(self) -> None:
        """Write the inputs that are due now; call it once before the robot starts."""
        writes = self._generator.writes(self._run.clock.now_us)
        if writes:
            self._apply(writes)

    def resume(self, steps: Iterable[Step], entries: Iterable[PersistentEntry]) -> None:
        """Go on after these steps of the boots before; call it once before the robot starts.

        :param entries: the persistent entries of NetworkTables that those have left
        """
        self.steps = list(steps)
        now_us = self._run.clock.now_us
        stays = what_stays([step for step in self.steps if step.at_us < now_us], now_us)
        for target, value in (without_entries(stays, entries) | dict(self.steps[-1].writes)).items():
            if target != RESTART:
                self._targets.write(target, value, now_us)

    def on_packet(self, now: float) -> bool:
        """Write the inputs of the next packet; return whether the match continues."""
        now_us = self._run.clock.now_us
        if now_us >= self._generator.next_us:
            self.write()
        self._targets.count_down(now_us)
        return not self.restarts and not self._generator.over(now_us)

    def _apply(self, writes: Mapping[str, Value]) -> None:
        now_us = self._run.clock.now_us
        if self.may_lack_targets:
            writes = {target: value for target, value in writes.items() if self._is_there(target)}
        self.steps.append(Step(now_us, writes))
        if self._journal is not None:
            self._journal.add(self.steps[-1])
        if writes.get(RESTART):
            self.restarts = True
            return
        for target, value in writes.items():
            self._targets.write(target, value, now_us)

    def _is_there(self, target: str) -> bool:
        try:
            self._targets.check(target)
            self._targets.check_made(target)
        except (PyfrcError, LookupError, TypeError):
            return False
        return True

    def script(self, robot: str, seed: int) -> InputScript:
        """Return the inputs up to now as a script that ends after this packet."""
        return InputScript(tuple(self.steps), self._run.clock.now_us + PACKET_US, robot=robot, seed=seed)
