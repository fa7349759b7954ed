"""The intake: rollers that take a game piece in, and a beam that it breaks when it is inside."""

import commands2
import wpilib


class Intake(commands2.Subsystem):
    """Takes a game piece in, and spits it out."""

    def __init__(self) -> None:
        super().__init__()
        self.motor = wpilib.PWMVictorSPX(2)
        self.beam = wpilib.DigitalInput(4)  # True as long as nothing is in its way

    def has_piece(self) -> bool:
        """Whether there is a game piece inside."""
        return not self.beam.get()

    def stop(self) -> None:
        """Stop the rollers."""
        self.motor.set(0)

    def take_in(self) -> commands2.Command:
        """A command that runs the rollers until a game piece is inside."""
        return self.runEnd(lambda: self.motor.set(0.7), self.stop).until(self.has_piece)

    def spit_out(self) -> commands2.Command:
        """A command that runs the rollers outwards for as long as it is let."""
        return self.runEnd(lambda: self.motor.set(-1.0), self.stop)
