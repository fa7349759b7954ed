"""What the elevator, the arm, the intake and the shooter do together."""

from commands2 import Command, cmd

from constants import Arm as ArmNumbers
from constants import Elevator as ElevatorNumbers
from subsystems.arm import Arm
from subsystems.elevator import Elevator
from subsystems.intake import Intake
from subsystems.shooter import Shooter


class Superstructure:
    """Makes commands that need several subsystems."""

    def __init__(self, elevator: Elevator, arm: Arm, intake: Intake, shooter: Shooter) -> None:
        self.elevator = elevator
        self.arm = arm
        self.intake = intake
        self.shooter = shooter

    def move(self, height: float, angle: float) -> Command:
        """Return a command that ends when both are there."""
        return cmd.parallel(self.elevator.move_to(height), self.arm.move_to(angle))

    def stow(self) -> Command:
        """Return a command that brings everything inside."""
        return self.move(ElevatorNumbers.STOWED, ArmNumbers.STOWED).withTimeout(2).withName("Stow")

    def fetch(self) -> Command:
        """Return a command that takes a game piece in, and then stows."""
        out = self.move(ElevatorNumbers.INTAKE, ArmNumbers.INTAKE)
        return cmd.parallel(out, self.intake.take_in()).andThen(self.stow()).withName("Fetch")

    def raise_to_score(self, height: float) -> Command:
        """Return a command that holds the piece at this height."""
        return self.move(height, ArmNumbers.SCORE).withName("Score")

    def shoot(self) -> Command:
        """Return a command that spins up, feeds when ready, and ends."""
        fed = cmd.waitUntil(self.shooter.ready).andThen(self.intake.feed())
        return cmd.deadline(fed, self.shooter.spin()).withName("Shoot")
