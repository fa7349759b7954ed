"""The steps of a shot."""

from magicbot import StateMachine, timed_state

from components.feeder import Feeder


class FeederControl(StateMachine):
    feeder: Feeder

    def shoot(self) -> None:
        self.engage()

    @timed_state(first=True, duration=3.0, next_state="feed")
    def spin_up(self) -> None:
        """Wait for the wheel, at most three seconds."""
        self.feeder.spin()
        if self.feeder.is_ready():
            self.next_state("feed")

    @timed_state(duration=0.6, next_state="rest", must_finish=True)
    def feed(self) -> None:
        self.feeder.spin()
        self.feeder.feed()

    @timed_state(duration=0.2, next_state="spin_up")
    def rest(self) -> None:
        self.feeder.spin()
