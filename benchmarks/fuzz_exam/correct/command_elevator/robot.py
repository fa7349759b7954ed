"""A command-based elevator with two limit switches, and a roller."""

import commands2
import commands2.button
import wpilib
from wpimath.controller import PIDController

TOP = 1.2  # metres


class Elevator(commands2.Subsystem):
    """Moves between two switches."""

    def __init__(self) -> None:
        super().__init__()
        self.motor = wpilib.PWMTalonFX(0)
        self.encoder = wpilib.Encoder(0, 1)
        self.encoder.setDistancePerPulse(0.0005)
        self.bottom = wpilib.DigitalInput(2)
        self.top = wpilib.DigitalInput(3)
        self.pid = PIDController(6.0, 0.0, 0.1)
        self.pid.setTolerance(0.02)

    def periodic(self) -> None:
        if not self.bottom.get():
            self.encoder.reset()
        wpilib.SmartDashboard.putNumber("Elevator", self.encoder.getDistance())

    def drive(self, power: float) -> None:
        """Move, but not past a switch. If both are pressed (cable off), do not move at all."""
        if power > 0 and not self.top.get():
            power = 0.0
        if power < 0 and not self.bottom.get():
            power = 0.0
        self.motor.set(max(-0.6, min(1.0, power)))

    def stop(self) -> None:
        self.motor.set(0.0)

    def go_to(self, metres: float) -> commands2.Command:
        """Make a command that goes to a height, and gives up after three seconds."""
        goal = max(0.0, min(TOP, metres))
        return (
            self.startRun(self.pid.reset, lambda: self.drive(self.pid.calculate(self.encoder.getDistance(), goal)))
            .until(self.pid.atSetpoint)
            .withTimeout(3.0)
            .finallyDo(lambda interrupted: self.stop())
        )

    def by_hand(self, power) -> commands2.Command:
        """Make a command that follows a stick."""
        return self.runEnd(lambda: self.drive(power()), self.stop)


class Roller(commands2.Subsystem):
    """Takes pieces in and gives them out."""

    def __init__(self) -> None:
        super().__init__()
        self.motor = wpilib.PWMVictorSPX(1)
        self.beam = wpilib.DigitalInput(4)

    def stop(self) -> None:
        self.motor.set(0.0)

    def run_at(self, power: float) -> commands2.Command:
        return self.runEnd(lambda: self.motor.set(power), self.stop)

    def has_piece(self) -> bool:
        return not self.beam.get()


class MyRobot(commands2.TimedCommandRobot):
    """Binds the buttons."""

    def robotInit(self) -> None:
        self.elevator = Elevator()
        self.roller = Roller()
        pad = self.pad = commands2.button.CommandXboxController(0)
        self.elevator.setDefaultCommand(self.elevator.by_hand(lambda: self.stick()))
        pad.a().onTrue(self.elevator.go_to(0.0))
        pad.b().onTrue(self.elevator.go_to(0.6))
        pad.y().onTrue(self.elevator.go_to(TOP))
        pad.rightBumper().whileTrue(self.roller.run_at(0.6).until(self.roller.has_piece))
        pad.leftBumper().whileTrue(self.roller.run_at(-0.8))
        # Both bumpers: the later one wins, because both need the roller.
        commands2.button.Trigger(self.roller.has_piece).and_(pad.x()).onTrue(self.deliver())
        self.chooser = wpilib.SendableChooser()
        self.chooser.setDefaultOption("Deliver", self.deliver())
        self.chooser.addOption("Nothing", None)
        wpilib.SmartDashboard.putData("Autonomous", self.chooser)
        self.autonomous: commands2.Command | None = None

    def stick(self) -> float:
        """Return the left stick's power outside its dead band."""
        value = -self.pad.getLeftY()
        return value if abs(value) > 0.12 else 0.0

    def deliver(self) -> commands2.Command:
        """Make a new sequence: up, out, down."""
        return commands2.cmd.sequence(
            self.elevator.go_to(TOP), self.roller.run_at(-0.8).withTimeout(0.5), self.elevator.go_to(0.0)
        )

    def autonomousInit(self) -> None:
        self.autonomous = self.chooser.getSelected()
        if self.autonomous is not None:
            self.autonomous.schedule()

    def teleopInit(self) -> None:
        if self.autonomous is not None:
            self.autonomous.cancel()

    def testInit(self) -> None:
        commands2.CommandScheduler.getInstance().cancelAll()
