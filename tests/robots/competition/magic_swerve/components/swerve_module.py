"""One corner of the swerve drive: two SPARK MAX and an absolute encoder."""

import math

import rev
import wpilib
from constants import (
    DRIVE_GEARING,
    DRIVE_KA,
    DRIVE_KS,
    DRIVE_KV,
    MODULES,
    STEER_GEARING,
    WHEEL_CIRCUMFERENCE,
)
from wpimath.controller import PIDController, SimpleMotorFeedforwardMeters
from wpimath.geometry import Rotation2d
from wpimath.kinematics import SwerveModulePosition, SwerveModuleState


class SwerveModule:
    """A driven wheel that can point anywhere."""

    def __init__(self, name: str) -> None:
        drive_id, steer_id, channel, straight_ahead, self.location = MODULES[name]
        self.name = name

        self.drive = rev.SparkMax(drive_id, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.smartCurrentLimit(50).voltageCompensation(12).setIdleMode(rev.SparkMaxConfig.IdleMode.kBrake)
        config.encoder.positionConversionFactor(WHEEL_CIRCUMFERENCE / DRIVE_GEARING)
        config.encoder.velocityConversionFactor(WHEEL_CIRCUMFERENCE / DRIVE_GEARING / 60)
        config.closedLoop.pid(0.05, 0, 0)
        self.drive.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.drive_encoder = self.drive.getEncoder()
        self.drive_loop = self.drive.getClosedLoopController()
        self.feedforward = SimpleMotorFeedforwardMeters(DRIVE_KS, DRIVE_KV, DRIVE_KA)

        self.steer = rev.SparkMax(steer_id, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.smartCurrentLimit(20).inverted(True).setIdleMode(rev.SparkMaxConfig.IdleMode.kCoast)
        config.encoder.positionConversionFactor(2 * math.pi / STEER_GEARING)
        self.steer.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.absolute_encoder = wpilib.DutyCycleEncoder(channel, 2 * math.pi, straight_ahead * 2 * math.pi)
        self.steer_pid = PIDController(5.0, 0, 0.05)
        self.steer_pid.enableContinuousInput(-math.pi, math.pi)

        self.desired = SwerveModuleState(0, Rotation2d())

    def angle(self) -> Rotation2d:
        """Return the wheel's direction; zero is straight ahead."""
        return Rotation2d(self.absolute_encoder.get())

    def position(self) -> SwerveModulePosition:
        """Return how far the wheel has rolled, and where it points."""
        return SwerveModulePosition(self.drive_encoder.getPosition(), self.angle())

    def state(self) -> SwerveModuleState:
        """Return how fast the wheel rolls, and where it points."""
        return SwerveModuleState(self.drive_encoder.getVelocity(), self.angle())

    def set(self, desired: SwerveModuleState) -> None:
        """Drive at a speed in a direction; the wheel turns by at most 90 degrees."""
        angle = self.angle()
        desired.optimize(angle)
        desired.cosineScale(angle)
        volts = self.feedforward.calculate(self.desired.speed, desired.speed)
        self.drive_loop.setSetpoint(desired.speed, rev.SparkMax.ControlType.kVelocity, arbFeedforward=volts)
        # The steering motor sits upside down, which its controller's inversion makes up for.
        self.steer.setVoltage(self.steer_pid.calculate(angle.radians(), desired.angle.radians()))
        self.desired = desired

    def stop(self) -> None:
        """Let the wheel roll out where it points."""
        self.desired = SwerveModuleState(0, self.angle())
        self.drive.stopMotor()
        self.steer.stopMotor()
