"""A wheel and the feeder before it."""

import math

import wpilib
from magicbot import feedback, tunable, will_reset_to


class Feeder:
    motor: wpilib.PWMVictorSPX
    wheel: wpilib.PWMSparkMax
    beam: wpilib.DigitalInput
    encoder: wpilib.Encoder

    speed = tunable(50.0)
    power = tunable(0.8)

    spinning = will_reset_to(False)
    feeding = will_reset_to(0.0)

    def wanted(self) -> float:
        """Return the wheel's speed, whatever stands on the dashboard."""
        return min(90.0, max(1.0, self.speed)) if math.isfinite(self.speed) else 50.0

    def spin(self) -> None:
        self.spinning = True

    def feed(self) -> None:
        self.feeding = self.power if math.isfinite(self.power) else 0.0

    def give_back(self) -> None:
        self.feeding = -0.5

    def is_ready(self) -> bool:
        return abs(self.encoder.getRate() - self.wanted()) < 3.0

    def has_ball(self) -> bool:
        return not self.beam.get()

    @feedback
    def get_part(self) -> float:
        return self.encoder.getRate() / self.wanted()

    def execute(self) -> None:
        error = self.wanted() - self.encoder.getRate()
        self.wheel.set(max(0.0, min(1.0, self.wanted() / 90 + 0.05 * error)) if self.spinning else 0.0)
        self.motor.set(max(-1.0, min(1.0, self.feeding)))

    def on_disable(self) -> None:
        self.wheel.set(0.0)
        self.motor.set(0.0)
