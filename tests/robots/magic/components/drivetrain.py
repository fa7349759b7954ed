"""The wheels."""

import wpilib


class Drivetrain:
    """Drives straight, and only while somebody asks for it."""

    left: wpilib.PWMSparkMax
    right: wpilib.PWMSparkMax

    def setup(self) -> None:
        """Called by magicbot once the motors are there."""
        self.speed = 0.0
        self.enabled_times = 0

    def on_enable(self) -> None:
        """Called by magicbot whenever the robot is enabled."""
        self.enabled_times += 1

    def go(self, speed: float) -> None:
        """Drive at this speed for one loop."""
        self.speed = speed

    def execute(self) -> None:
        """Called by magicbot at the end of each loop: the only place that touches the motors."""
        self.left.set(self.speed)
        self.right.set(self.speed)
        self.speed = 0.0
