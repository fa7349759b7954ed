"""The intake: rollers that pull a game piece in, and a beam that the game piece breaks when it is inside."""

import commands2
import wpilib
import wpilib_drivers


class Intake(commands2.Subsystem):
    """Pull a game piece in, and push it out."""

    def __init__(self) -> None:
        super().__init__()
        self.motor = wpilib_drivers.PWMVictorSPX(2)
        self.beam = wpilib.DigitalInput(4)  # True while nothing breaks the beam

    def has_piece(self) -> bool:
        """Return whether a game piece is inside."""
        return not self.beam.get()

    def stop(self) -> None:
        """Stop the rollers."""
        self.motor.set_throttle(0)

    def take_in(self) -> commands2.Command:
        """Return a command that runs the rollers until a game piece is inside."""
        return self.run_end(lambda: self.motor.set_throttle(0.7), self.stop).until(self.has_piece)

    def spit_out(self) -> commands2.Command:
        """Return a command that runs the rollers outwards until it is interrupted."""
        return self.run_end(lambda: self.motor.set_throttle(-1.0), self.stop)
