"""One MAXSwerve module: a NEO drives the wheel, a NEO 550 turns it."""

import math

import rev
from wpimath.geometry import Rotation2d
from wpimath.kinematics import SwerveModulePosition, SwerveModuleState

from constants import Drive


def driving_config() -> rev.SparkMaxConfig:
    """Return the settings of a driving motor: metres, and a velocity loop."""
    metres_per_rotation = Drive.WHEEL_DIAMETER * math.pi / Drive.DRIVING_REDUCTION
    config = rev.SparkMaxConfig()
    config.setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake).smartCurrentLimit(Drive.DRIVING_CURRENT_LIMIT)
    config.encoder.positionConversionFactor(metres_per_rotation).velocityConversionFactor(metres_per_rotation / 60)
    config.closedLoop.setFeedbackSensor(rev.FeedbackSensor.kPrimaryEncoder).pid(Drive.DRIVING_KP, 0, 0)
    config.closedLoop.outputRange(-1, 1).feedForward.kV(12 / Drive.FREE_SPEED)
    return config


def turning_config() -> rev.SparkMaxConfig:
    """Return the settings of a turning motor: radians, and a position loop that wraps around."""
    config = rev.SparkMaxConfig()
    config.setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake).smartCurrentLimit(Drive.TURNING_CURRENT_LIMIT)
    config.absoluteEncoder.positionConversionFactor(math.tau).velocityConversionFactor(math.tau / 60)
    config.closedLoop.setFeedbackSensor(rev.FeedbackSensor.kAbsoluteEncoder).pid(Drive.TURNING_KP, 0, 0)
    config.closedLoop.outputRange(-1, 1).positionWrappingEnabled(True).positionWrappingInputRange(0, math.tau)
    return config


class SwerveModule:
    """Drives at the speed and in the direction that it is set to. Both loops run on the SPARKs."""

    def __init__(self, name: str, driving_id: int, turning_id: int, offset: Rotation2d) -> None:
        self.name = name
        self.offset = offset
        self.driving_motor = rev.SparkMax(driving_id, rev.SparkMax.MotorType.kBrushless)
        self.turning_motor = rev.SparkMax(turning_id, rev.SparkMax.MotorType.kBrushless)
        for motor, config in ((self.driving_motor, driving_config()), (self.turning_motor, turning_config())):
            motor.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)

        self.driving_encoder = self.driving_motor.getEncoder()
        self.turning_encoder = self.turning_motor.getAbsoluteEncoder()
        self.driving_loop = self.driving_motor.getClosedLoopController()
        self.turning_loop = self.turning_motor.getClosedLoopController()
        self.driving_encoder.setPosition(0)
        self.desired = SwerveModuleState(0, self.angle())

    def angle(self) -> Rotation2d:
        """Return the wheel's direction, relative to the robot."""
        return Rotation2d(self.turning_encoder.getPosition()) - self.offset

    def state(self) -> SwerveModuleState:
        """Return the measured speed and direction."""
        return SwerveModuleState(self.driving_encoder.getVelocity(), self.angle())

    def position(self) -> SwerveModulePosition:
        """Return the distance that the wheel has rolled, and its direction."""
        return SwerveModulePosition(self.driving_encoder.getPosition(), self.angle())

    def set_desired(self, state: SwerveModuleState) -> None:
        """Drive with this speed and direction, turning the wheel by at most 90 degrees."""
        angle = self.angle()
        state.optimize(angle)
        state.cosineScale(angle)
        self.desired = state
        self.driving_loop.setSetpoint(state.speed, rev.SparkBase.ControlType.kVelocity)
        target = (state.angle + self.offset).radians() % math.tau
        self.turning_loop.setSetpoint(target, rev.SparkBase.ControlType.kPosition)

    def stop(self) -> None:
        """Switch both motors off."""
        self.driving_motor.stopMotor()
        self.turning_motor.stopMotor()
        self.desired = SwerveModuleState(0, self.angle())

    def has_fault(self) -> bool:
        """Return whether one of the two SPARKs reports a fault."""
        return self.driving_motor.hasActiveFault() or self.turning_motor.hasActiveFault()
