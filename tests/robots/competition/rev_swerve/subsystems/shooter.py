"""Two flywheels shoot what the feeder gives them."""

import commands2
import rev
import wpilib

from constants import CanIds, Ports
from constants import Shooter as Settings


class Shooter(commands2.Subsystem):
    """Flywheels with a velocity loop on their SPARK Flexes, a feeder, and a light barrier in it."""

    def __init__(self) -> None:
        super().__init__()
        self.top = rev.SparkFlex(CanIds.TOP_FLYWHEEL, rev.SparkFlex.MotorType.kBrushless)
        self.bottom = rev.SparkFlex(CanIds.BOTTOM_FLYWHEEL, rev.SparkFlex.MotorType.kBrushless)
        for motor, inverted in ((self.top, False), (self.bottom, True)):
            config = rev.SparkFlexConfig()
            config.setIdleMode(rev.SparkBaseConfig.IdleMode.kCoast).smartCurrentLimit(60).inverted(inverted)
            config.closedLoop.setFeedbackSensor(rev.FeedbackSensor.kPrimaryEncoder).pid(Settings.KP, 0, 0)
            config.closedLoop.feedForward.kV(12 / 6784)
            motor.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.feeder = rev.SparkMax(CanIds.FEEDER, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake).smartCurrentLimit(20)
        self.feeder.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.encoders = (self.top.getEncoder(), self.bottom.getEncoder())
        self.loops = (self.top.getClosedLoopController(), self.bottom.getClosedLoopController())
        self.beam = wpilib.DigitalInput(Ports.FEEDER_BEAM)
        self.goal = 0.0
        wpilib.Preferences.initDouble("ShooterRpm", Settings.SPIN_UP_RPM)

    def has_piece(self) -> bool:
        """Return whether a game piece is in the feeder."""
        return not self.beam.get()

    def speed(self) -> float:
        """Return the speed of the slower flywheel, in rpm."""
        return min(encoder.getVelocity() for encoder in self.encoders)

    def at_speed(self) -> bool:
        """Return whether both flywheels are fast enough to shoot."""
        return self.goal > 0 and all(
            abs(encoder.getVelocity() - self.goal) < Settings.TOLERANCE_RPM for encoder in self.encoders
        )

    def spin(self, rpm: float) -> None:
        """Turn the flywheels with this speed. 0 lets them coast."""
        self.goal = rpm
        if rpm == 0:
            self.top.stopMotor()
            self.bottom.stopMotor()
            return
        for loop in self.loops:
            loop.setSetpoint(rpm, rev.SparkBase.ControlType.kVelocity)

    def stop(self) -> None:
        """Stop the flywheels and the feeder."""
        self.spin(0)
        self.feeder.stopMotor()

    def spin_up(self) -> commands2.Command:
        """Return a command that keeps the flywheels at the speed in the preferences."""
        return self.runEnd(lambda: self.spin(wpilib.Preferences.getDouble("ShooterRpm")), self.stop)

    def idle(self) -> commands2.Command:
        """Return the default command: slow while there is a piece to shoot, else off."""

        def execute() -> None:
            self.spin(Settings.IDLE_RPM if self.has_piece() else 0)
            self.feeder.set(0)

        return self.run(execute).withName("Idle")

    def shoot(self) -> commands2.Command:
        """Return a command that spins up, and feeds as soon as the speed is right."""

        def spin() -> None:
            self.spin(wpilib.Preferences.getDouble("ShooterRpm"))

        def feed() -> None:
            spin()
            self.feeder.set(Settings.FEED_POWER)

        return (
            self.run(spin)
            .until(self.at_speed)
            .withTimeout(2.0)
            .andThen(self.run(feed).withTimeout(Settings.FEED_SECONDS))
            .finallyDo(lambda interrupted: self.stop())
            .withName("Shoot")
        )

    def load(self) -> commands2.Command:
        """Return a command that runs the feeder until a piece is in it."""
        return self.runEnd(lambda: self.feeder.set(0.3), self.stop).until(self.has_piece)

    def periodic(self) -> None:
        """Publish the speeds."""
        wpilib.SmartDashboard.putNumber("Shooter/Top", self.encoders[0].getVelocity())
        wpilib.SmartDashboard.putNumber("Shooter/Bottom", self.encoders[1].getVelocity())
        wpilib.SmartDashboard.putBoolean("Shooter/AtSpeed", self.at_speed())
        wpilib.SmartDashboard.putBoolean("Shooter/HasPiece", self.has_piece())
