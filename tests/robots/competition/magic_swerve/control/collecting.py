"""Collect balls until the hopper is full, and free what is stuck."""

from components.indexer import Indexer
from components.intake import Intake
from magicbot import StateMachine, state, timed_state, tunable


class CollectControl(StateMachine):
    """While `collect` is called, the intake is down."""

    intake: Intake
    indexer: Indexer

    jam_current = tunable(35.0)

    def collect(self) -> None:
        """Collect; call it in each loop."""
        self.engage()

    @state(first=True)
    def lower(self) -> None:
        """Wait for the arm."""
        self.intake.collect()
        if self.intake.is_down():
            self.next_state("pull_in")

    @state
    def pull_in(self, state_tm: float) -> None:
        """Pull in until the hopper is full."""
        self.intake.collect()
        self.indexer.load()
        if self.indexer.is_full():
            self.done()
        elif state_tm > 0.5 and self.intake.roller.getOutputCurrent() > self.jam_current:
            self.next_state("free")

    @timed_state(duration=0.3, next_state="pull_in", must_finish=True)
    def free(self) -> None:
        """Push out what is stuck."""
        self.intake.eject()
        self.indexer.reverse()
