"""The shooter: a wheel that throws, and a feeder that pushes a ball into it."""

import wpilib
from magicbot import feedback, tunable, will_reset_to

FULL_SPEED = 80.0  # of the wheel, in turns a second
TOLERANCE = 2.0


class Shooter:
    """Spins the wheel and feeds balls as it is told, and stops when nobody tells it anything."""

    wheel_motor: wpilib.PWMSparkMax
    feeder_motor: wpilib.PWMVictorSPX
    wheel_encoder: wpilib.Encoder

    # The speed to shoot at, in turns a second; on the dashboard, to be changed there.
    speed = tunable(60.0)

    spinning = will_reset_to(False)
    feeding = will_reset_to(False)

    def spin(self) -> None:
        """Have the wheel turn for this moment."""
        self.spinning = True

    def feed(self) -> None:
        """Have the feeder run for this moment."""
        self.feeding = True

    @feedback
    def wheel_speed(self) -> float:
        """How fast the wheel turns, in turns a second; shown on the dashboard."""
        return self.wheel_encoder.getRate()

    def is_ready(self) -> bool:
        """Whether the wheel has come up to its speed."""
        return abs(self.wheel_speed() - self.speed) < TOLERANCE

    def execute(self) -> None:
        """Called every 20 ms while the robot is enabled."""
        self.wheel_motor.set(self.wheel_power() if self.spinning else 0.0)
        self.feeder_motor.set(1.0 if self.feeding else 0.0)

    def wheel_power(self) -> float:
        """What the speed takes, and more of it the more is missing; from 0 to 1."""
        missing = self.speed - self.wheel_speed()
        return max(0.0, min(1.0, self.speed / FULL_SPEED + 0.1 * missing))

    def on_disable(self) -> None:
        """Called once when the robot is disabled."""
        self.wheel_motor.set(0.0)
        self.feeder_motor.set(0.0)
