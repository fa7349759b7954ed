"""The misbehavior of one run. It is noted, and the match goes on: later bugs are found in the same match."""

from __future__ import annotations

from ...invariants.watch import BrokenInvariantError
from ...project.robot_files import RobotFiles
from ...runtime.clock import PACKET_US, Clock
from ...runtime.threads.robot_threads import RobotThreads
from .failure import FuzzFailure, MisbehaviorError, NotedFailure, failure_of

#: After these the robot's program does nothing that is of interest.
_ENDS_A_MATCH = ("stuck_modes",)


class MisbehaviorNotes:
    """Notes each misbehavior of a run once; decides which one ends the run.

    :param ends_with: a failure that ends the run
    """

    def __init__(self, clock: Clock, files: RobotFiles, ends_with: FuzzFailure | None = None) -> None:
        self.found: list[NotedFailure] = []
        self._clock = clock
        self._files = files
        self._ends_with = ends_with

    def ends_run(self, error: MisbehaviorError | BrokenInvariantError) -> bool:
        """Note a misbehavior or a broken rule; return whether the run ends with it."""
        failure = failure_of(error, self._files)
        if error.kind in _ENDS_A_MATCH or failure.same_as(self._ends_with):
            return True
        if not any(failure.same_as(noted.failure) for noted in self.found):
            self.found.append(NotedFailure(failure, self._clock.now_us + PACKET_US))
        return False


class LastMisbehavior:
    """Ends the replay of a script with the last misbehavior in it, for which the script was saved.

    :param end_us: the end of the script
    """

    def __init__(self, clock: Clock, threads: RobotThreads, end_us: int) -> None:
        self._clock = clock
        self._threads = threads
        self._last_packet_us = end_us - PACKET_US
        self._noted: MisbehaviorError | None = None

    def ends_run(self, error: MisbehaviorError) -> bool:
        """Note a misbehavior; return whether the run ends with it."""
        self._noted = error
        return error.kind in _ENDS_A_MATCH or self._clock.now_us >= self._last_packet_us

    def after_packet(self, now: float) -> None:
        """End the run with its last packet, if there was misbehavior before."""
        if self._noted is not None and self._clock.now_us >= self._last_packet_us and self._threads.failure is None:
            self._threads.fail(self._noted)
