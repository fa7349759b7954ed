"""The launcher, and the state machine that fires it."""

import wpilib
from magicbot import StateMachine, state, timed_state


class Launcher:
    """A wheel that throws, and a feeder that pushes a ball into it."""

    wheel: wpilib.PWMSparkMax
    feeder: wpilib.PWMSparkMax

    def setup(self) -> None:
        """Called by magicbot once the motors are there."""
        self.spinning = False
        self.feeding = False

    def spin(self) -> None:
        """Turn the wheel for one loop."""
        self.spinning = True

    def feed(self) -> None:
        """Push for one loop."""
        self.feeding = True

    def execute(self) -> None:
        """Do what was asked for in this loop, and forget it."""
        self.wheel.set(1.0 if self.spinning else 0.0)
        self.feeder.set(0.5 if self.feeding else 0.0)
        self.spinning = False
        self.feeding = False


class LauncherControl(StateMachine):
    """Spins up, feeds one ball, and is done.

    The times end between two loops, so that rounding cannot make a state one loop longer.
    """

    launcher: Launcher

    def setup(self) -> None:
        """Called by magicbot: no ball thrown yet."""
        self.thrown = 0

    def fire(self) -> None:
        """Ask for a shot; it goes on while this is called, and once feeding, to its end."""
        self.engage()

    @timed_state(duration=0.99, first=True, next_state="feeding")
    def spin_up(self) -> None:
        """Give the wheel a second to come up to speed."""
        self.launcher.spin()

    @timed_state(duration=0.49, next_state="finish", must_finish=True)
    def feeding(self) -> None:
        """Push the ball in, and do not stop half way."""
        self.launcher.spin()
        self.launcher.feed()

    @state(must_finish=True)
    def finish(self) -> None:
        """Count the ball."""
        self.thrown += 1
        self.done()
