"""Drive so and so far, straight on."""

import commands2
from wpimath.controller import PIDController

from subsystems.drive import Drive

MAX_POWER = 0.6


class DriveDistance(commands2.Command):
    """Ends when the robot has driven so far and stands there."""

    def __init__(self, drive: Drive, metres: float) -> None:
        """`metres` is how far, as seen from where the robot is when the command starts; negative is backwards."""
        super().__init__()
        self.addRequirements(drive)  # nothing else drives meanwhile
        self.drive = drive
        self.metres = metres
        self.distance = PIDController(1.5, 0.0, 0.1)
        self.distance.setTolerance(0.02, 0.05)
        self.heading = PIDController(0.02, 0.0, 0.0)

    def initialize(self) -> None:
        """Called once when the command starts."""
        self.distance.reset()
        self.distance.setSetpoint(self.drive.distance() + self.metres)
        self.heading.setSetpoint(self.drive.heading())

    def execute(self) -> None:
        """Called every 20 ms: slower as the robot comes near, and back to where it faced."""
        power = self.distance.calculate(self.drive.distance())
        turn = self.heading.calculate(self.drive.heading())
        self.drive.go(max(-MAX_POWER, min(MAX_POWER, power)), max(-MAX_POWER, min(MAX_POWER, turn)))

    def isFinished(self) -> bool:
        """Whether the robot is there."""
        return self.distance.atSetpoint()

    def end(self, interrupted: bool) -> None:
        """Called once when the command is over, also when something else took its place."""
        self.drive.stop()
