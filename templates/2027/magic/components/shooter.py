"""The shooter: a wheel that throws, and a feeder that pushes a ball into it."""

import wpilib
import wpilib_drivers
from magicbot import feedback, tunable, will_reset_to

FULL_SPEED = 80.0  # of the wheel, in turns per second
TOLERANCE = 2.0


class Shooter:
    """Spin the wheel and feed balls as requested, and stop when there is no request."""

    wheel_motor: wpilib_drivers.PWMSparkMax
    feeder_motor: wpilib_drivers.PWMVictorSPX
    wheel_encoder: wpilib.Encoder

    # The speed for a shot, in turns per second; it can be changed on the dashboard.
    speed = tunable(60.0)

    spinning = will_reset_to(False)
    feeding = will_reset_to(False)

    def spin(self) -> None:
        """Spin the wheel for the next 20 ms."""
        self.spinning = True

    def feed(self) -> None:
        """Run the feeder for the next 20 ms."""
        self.feeding = True

    @feedback
    def wheel_speed(self) -> float:
        """Return the wheel's speed in turns per second; the dashboard shows it."""
        return self.wheel_encoder.get_rate()

    def is_ready(self) -> bool:
        """Return whether the wheel has reached its speed."""
        return abs(self.wheel_speed() - self.speed) < TOLERANCE

    def execute(self) -> None:
        """Called every 20 ms while the robot is enabled."""
        self.wheel_motor.set_throttle(self.wheel_power() if self.spinning else 0.0)
        self.feeder_motor.set_throttle(1.0 if self.feeding else 0.0)

    def wheel_power(self) -> float:
        """Return the motor's power from 0 to 1: feedforward for the speed, and more if the wheel is too slow."""
        missing = self.speed - self.wheel_speed()
        return max(0.0, min(1.0, self.speed / FULL_SPEED + 0.1 * missing))

    def on_disable(self) -> None:
        """Called once when the robot is disabled."""
        self.wheel_motor.set_throttle(0.0)
        self.feeder_motor.set_throttle(0.0)
