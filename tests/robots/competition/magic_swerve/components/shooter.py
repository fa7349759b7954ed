"""Two flywheels and a hood on a servo."""

import itertools

import rev
import wpilib
from constants import SHOOTER_KS, SHOOTER_KV, SHOTS
from magicbot import feedback, tunable, will_reset_to
from wpimath.filter import LinearFilter


class Shooter:
    """Shoots at the speed and the angle that belong to a distance."""

    left: rev.SparkMax
    right: rev.SparkMax
    hood: wpilib.Servo

    tolerance = tunable(90.0)
    idle_rpm = tunable(900.0)
    trim = tunable(1.0)

    target = will_reset_to(0.0)

    def setup(self) -> None:
        """Find the wheels' encoder and controller."""
        self.encoder = self.left.getEncoder()
        self.loop = self.left.getClosedLoopController()
        self.filter = LinearFilter.movingAverage(5)
        self.hood_position = 0.0
        self.rpm = 0.0

    def aim(self, distance: float) -> None:
        """Choose speed and hood for a distance to the hub (m); call it in each loop."""
        distances = sorted(SHOTS)
        distance = min(max(distance, distances[0]), distances[-1])
        for near, far in itertools.pairwise(distances):
            if near <= distance <= far:
                part = (distance - near) / (far - near)
                (slow, low), (fast, high) = SHOTS[near], SHOTS[far]
                self.target = self.trim * (slow + part * (fast - slow))
                self.hood_position = low + part * (high - low)
                return

    def idle(self) -> None:
        """Keep the wheels turning, so that the next shot comes sooner."""
        self.target = self.idle_rpm

    def is_ready(self) -> bool:
        """Return whether the wheels have the speed that was asked for."""
        return self.target > self.idle_rpm and abs(self.rpm - self.target) < self.tolerance

    @feedback
    def get_rpm(self) -> float:
        return self.encoder.getVelocity()

    @feedback
    def get_current(self) -> float:
        return self.left.getOutputCurrent() + self.right.getOutputCurrent()

    def execute(self) -> None:
        """Turn the wheels."""
        self.rpm = self.filter.calculate(self.encoder.getVelocity())
        self.hood.set(self.hood_position)
        if self.target > 0:
            volts = SHOOTER_KS + SHOOTER_KV * self.target
            self.loop.setSetpoint(self.target, rev.SparkMax.ControlType.kVelocity, arbFeedforward=volts)
        else:
            self.left.set(0)

    def on_disable(self) -> None:
        """Let the wheels run out."""
        self.left.stopMotor()
        self.filter.reset()
