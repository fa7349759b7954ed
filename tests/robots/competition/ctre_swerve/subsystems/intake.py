"""The intake: a roller, and a beam across it that a game piece breaks."""

from commands2 import Command, Subsystem
from phoenix6.controls import DutyCycleOut
from phoenix6.hardware import TalonFX
from wpilib import DigitalInput, SmartDashboard
from wpimath.filter import Debouncer

from constants import Can, roller_config
from subsystems.devices import Connections, configure


class Intake(Subsystem):
    """Takes game pieces in, and feeds them to the shooter."""

    def __init__(self) -> None:
        super().__init__()
        self.motor = TalonFX(Can.INTAKE)
        configure(self.motor, roller_config())
        self.request = DutyCycleOut(0)
        self.current = self.motor.get_stator_current()
        self.current.set_update_frequency(50)
        # The receiver pulls its input to ground while it does not see the beam.
        self.beam = DigitalInput(1)
        self.debouncer = Debouncer(0.06, Debouncer.DebounceType.kBoth)
        self.connections = Connections(self.motor)
        self.loaded = False

    def periodic(self) -> None:
        """Watch the beam."""
        self.current.refresh()
        self.connections.update()
        self.loaded = self.debouncer.calculate(not self.beam.get())
        SmartDashboard.putBoolean("Intake/Loaded", self.loaded)
        SmartDashboard.putNumber("Intake/Current", self.current.value)

    def roll(self, output: float) -> Command:
        """Return a command that turns the roller, from -1 to 1."""
        return self.runEnd(
            lambda: self.motor.set_control(self.request.with_output(output)),
            lambda: self.motor.set_control(self.request.with_output(0)),
        ).withName("Roll")

    def take_in(self) -> Command:
        """Return a command that rolls until a game piece is in the robot."""
        return self.roll(0.7).until(lambda: self.loaded).withName("Take in")

    def feed(self) -> Command:
        """Return a command that pushes the game piece into the shooter."""
        return self.roll(1.0).withTimeout(0.5).withName("Feed")
