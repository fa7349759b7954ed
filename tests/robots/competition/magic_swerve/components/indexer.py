"""The belt between intake and shooter, with a light barrier at each end."""

import wpilib
from magicbot import feedback, tunable, will_reset_to
from wpimath.filter import Debouncer


class Indexer:
    """Counts what comes in and what goes out."""

    belt: wpilib.PWMVictorSPX
    entry: wpilib.DigitalInput
    exit: wpilib.DigitalInput

    feed_speed = tunable(1.0)
    load_speed = tunable(0.45)
    capacity = tunable(8)

    speed = will_reset_to(0.0)

    def setup(self) -> None:
        """Begin with what the robot is loaded with."""
        self.balls = 3
        self.shot = 0
        self.entry_filter = Debouncer(0.04, Debouncer.DebounceType.kBoth)
        self.exit_filter = Debouncer(0.02, Debouncer.DebounceType.kRising)
        self.was_entering = self.was_leaving = False

    def feed(self) -> None:
        """Push balls into the shooter; call it in each loop."""
        self.speed = self.feed_speed

    def load(self) -> None:
        """Make room for what comes in; call it in each loop."""
        self.speed = self.load_speed

    def reverse(self) -> None:
        """Give balls back to the intake; call it in each loop."""
        self.speed = -self.load_speed

    def is_full(self) -> bool:
        return self.balls >= self.capacity

    @feedback
    def get_balls(self) -> int:
        return self.balls

    @feedback
    def get_shot(self) -> int:
        return self.shot

    def count(self) -> None:
        """Look at the light barriers, which are open when a ball is in them: also while disabled."""
        entering = self.entry_filter.calculate(not self.entry.get())
        leaving = self.exit_filter.calculate(not self.exit.get())
        if entering and not self.was_entering:
            self.balls += 1
        if leaving and not self.was_leaving:
            self.balls = max(0, self.balls - 1)
            self.shot += 1
        self.was_entering, self.was_leaving = entering, leaving

    def execute(self) -> None:
        """Move the belt."""
        self.belt.set(self.speed)

    def on_disable(self) -> None:
        """Stop the belt."""
        self.belt.stopMotor()
