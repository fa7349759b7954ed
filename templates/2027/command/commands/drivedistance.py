"""Drive straight for a distance."""

import commands2
from wpimath import PIDController

from subsystems.drive import Drive

MAX_POWER = 0.6


class DriveDistance(commands2.Command):
    """Drive straight for a distance. The command ends when the robot has stopped there."""

    def __init__(self, drive: Drive, metres: float) -> None:
        """Drive `metres` from the robot's position at the start of the command; negative is backwards."""
        super().__init__()
        self.add_requirements(drive)  # no other command drives at the same time
        self.drive = drive
        self.metres = metres
        self.distance = PIDController(1.5, 0.0, 0.1)
        self.distance.set_tolerance(0.02, 0.05)
        self.heading = PIDController(0.02, 0.0, 0.0)

    def initialize(self) -> None:
        """Called once when the command starts."""
        self.distance.reset()
        self.distance.set_setpoint(self.drive.distance() + self.metres)
        self.heading.set_setpoint(self.drive.heading())

    def execute(self) -> None:
        """Called every 20 ms: drive slower near the goal, and keep the heading."""
        power = self.distance.calculate(self.drive.distance())
        turn = self.heading.calculate(self.drive.heading())
        self.drive.go(max(-MAX_POWER, min(MAX_POWER, power)), max(-MAX_POWER, min(MAX_POWER, turn)))

    def is_finished(self) -> bool:
        """Return whether the robot has arrived."""
        return self.distance.at_setpoint()

    def end(self, interrupted: bool) -> None:
        """Called once when the command ends or is interrupted."""
        self.drive.stop()
