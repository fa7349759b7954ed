"""The climber: a winch that pulls the robot up."""

import math

import commands2
import rev
import wpilib

from constants import CanIds
from constants import Climber as Settings


class Climber(commands2.Subsystem):
    """A hook on a winch. A switch at the SPARK MAX stops it at the bottom, a soft limit at the top."""

    def __init__(self) -> None:
        super().__init__()
        self.motor = rev.SparkMax(CanIds.CLIMBER, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake).smartCurrentLimit(60)
        config.encoder.positionConversionFactor(math.tau * Settings.DRUM_RADIUS / Settings.REDUCTION)
        config.softLimit.forwardSoftLimit(Settings.MAX_TRAVEL).forwardSoftLimitEnabled(True)
        self.motor.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.encoder = self.motor.getEncoder()
        self.bottom_switch = self.motor.getReverseLimitSwitch()
        self.armed = False

    def extension(self) -> float:
        """Return how far the hook is out, in metres."""
        return self.encoder.getPosition()

    def at_bottom(self) -> bool:
        """Return whether the hook is in."""
        return self.bottom_switch.get()

    def arm(self) -> commands2.Command:
        """Return a command after which the climber obeys, so that no button moves it by mistake."""
        return self.runOnce(lambda: setattr(self, "armed", True)).withName("ArmClimber")

    def extend(self) -> commands2.Command:
        """Return a command that moves the hook up until it is out."""
        return (
            self.runEnd(lambda: self.motor.set(Settings.UP_POWER), self.motor.stopMotor)
            .until(lambda: self.extension() >= Settings.MAX_TRAVEL)
            .onlyIf(lambda: self.armed)
        )

    def retract(self) -> commands2.Command:
        """Return a command that pulls until the hook is in."""
        return (
            self.runEnd(lambda: self.motor.set(Settings.DOWN_POWER), self.motor.stopMotor)
            .until(self.at_bottom)
            .onlyIf(lambda: self.armed)
        )

    def periodic(self) -> None:
        """Publish the state."""
        wpilib.SmartDashboard.putBoolean("Climber/Armed", self.armed)
        wpilib.SmartDashboard.putNumber("Climber/Extension", self.extension())
