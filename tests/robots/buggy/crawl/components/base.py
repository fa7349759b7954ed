"""The drive base: a tank drive with one wheel across, so that it goes in any direction."""

import wpilib
from magicbot import tunable, will_reset_to
from wpimath.filter import LinearFilter
from wpimath.geometry import Rotation2d, Translation2d

LOOP_SECONDS = 0.02
SMOOTHING_SECONDS = 0.1

STANDING = Translation2d(0, 0)


def clamped(power: float) -> float:
    """At most full power."""
    return max(min(power, 1.0), -1.0)


class Base:
    """Goes where the field is, not where the robot looks; its fan turns as fast as the motors are driven."""

    left: wpilib.PWMSparkMax
    right: wpilib.PWMSparkMax
    across: wpilib.PWMSparkMax
    fan: wpilib.DigitalOutput
    gyro: wpilib.AnalogGyro

    crawl_speed = tunable(0.25)
    velocity = will_reset_to(STANDING)
    turn = will_reset_to(0.0)

    def setup(self) -> None:
        """Called by magicbot once the devices are there."""
        self.forward_filter = LinearFilter.singlePoleIIR(SMOOTHING_SECONDS, LOOP_SECONDS)
        self.across_filter = LinearFilter.singlePoleIIR(SMOOTHING_SECONDS, LOOP_SECONDS)
        self.fan.enablePWM(0.0)

    def on_enable(self) -> None:
        """Called by magicbot: begin at rest."""
        self.forward_filter.reset()
        self.across_filter.reset()

    def on_disable(self) -> None:
        """Called by magicbot: nothing moves."""
        for motor in (self.left, self.right, self.across):
            motor.set(0.0)
        self.fan.updateDutyCycle(0.0)

    def go(self, stick: Translation2d, turn: float) -> None:
        """Drive for one loop.

        :param stick: along the field, and to its left; each from -1 to 1
        :param turn: from -1 to 1, counterclockwise
        """
        self.velocity = stick
        self.turn = turn

    def crawl(self, stick: Translation2d) -> None:
        """Drive slowly for one loop, where the stick points to, however far it is pushed."""
        direction = stick / stick.norm()  # the bug: 0/0 is no exception here but NaN, which the filters keep
        self.velocity = direction * self.crawl_speed

    def execute(self) -> None:
        """Called by magicbot at the end of each loop: the only place that touches the motors."""
        velocity = self.velocity.rotateBy(Rotation2d.fromDegrees(self.gyro.getAngle()))
        forward = self.forward_filter.calculate(velocity.X())
        across = self.across_filter.calculate(velocity.Y())
        self.left.set(clamped(forward - self.turn))
        self.right.set(clamped(forward + self.turn))
        self.across.set(clamped(across))
        self.fan.updateDutyCycle(min(abs(forward) + abs(across), 1.0))
