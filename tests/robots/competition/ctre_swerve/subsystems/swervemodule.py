"""One module of the swerve drive: two TalonFX that close their own loops, and a CANcoder."""

import math

from phoenix6 import BaseStatusSignal
from phoenix6.controls import NeutralOut, PositionVoltage, VelocityVoltage, VoltageOut
from phoenix6.hardware import CANcoder, TalonFX
from wpimath.geometry import Rotation2d
from wpimath.kinematics import SwerveModulePosition, SwerveModuleState

from constants import Swerve, drive_config, encoder_config, steer_config
from subsystems.devices import configure

WHEEL_CIRCUMFERENCE = math.tau * Swerve.WHEEL_RADIUS


class SwerveModule:
    """Rolls and turns one wheel. `signals` are for the drivetrain, which refreshes those of all modules together."""

    def __init__(self, name: str, drive_id: int, steer_id: int, encoder_id: int, offset: float) -> None:
        self.name = name
        self.drive_motor = TalonFX(drive_id)
        self.steer_motor = TalonFX(steer_id)
        self.encoder = CANcoder(encoder_id)
        configure(self.encoder, encoder_config(offset))
        configure(self.drive_motor, drive_config())
        configure(self.steer_motor, steer_config(encoder_id))

        self.velocity_request = VelocityVoltage(0, enable_foc=False)
        self.voltage_request = VoltageOut(0)
        self.position_request = PositionVoltage(0, enable_foc=False)
        self.neutral_request = NeutralOut()

        self.drive_position = self.drive_motor.get_position()
        self.drive_velocity = self.drive_motor.get_velocity()
        self.drive_current = self.drive_motor.get_supply_current()
        self.steer_position = self.steer_motor.get_position()
        self.steer_velocity = self.steer_motor.get_velocity()
        self.absolute_position = self.encoder.get_absolute_position()
        self.signals: list[BaseStatusSignal] = [
            self.drive_position,
            self.drive_velocity,
            self.drive_current,
            self.steer_position,
            self.steer_velocity,
            self.absolute_position,
        ]
        self.target = SwerveModuleState()

    @property
    def devices(self) -> tuple[TalonFX, TalonFX, CANcoder]:
        """The module's CAN devices."""
        return self.drive_motor, self.steer_motor, self.encoder

    def angle(self) -> Rotation2d:
        """Return the direction of the wheel, a little ahead of the signal, as it turns."""
        turned = BaseStatusSignal.get_latency_compensated_value(self.steer_position, self.steer_velocity)
        return Rotation2d.fromRotations(turned)

    def position(self) -> SwerveModulePosition:
        """Return how far the wheel has rolled, in metres, and its direction."""
        rolled = BaseStatusSignal.get_latency_compensated_value(self.drive_position, self.drive_velocity)
        return SwerveModulePosition(rolled * WHEEL_CIRCUMFERENCE, self.angle())

    def state(self) -> SwerveModuleState:
        """Return the speed of the wheel, in metres per second, and its direction."""
        return SwerveModuleState(self.drive_velocity.value * WHEEL_CIRCUMFERENCE, self.angle())

    def set_target(self, target: SwerveModuleState) -> None:
        """Turn the shorter way, and roll slower while the wheel points elsewhere."""
        angle = self.angle()
        target.optimize(angle)
        target.cosineScale(angle)
        self.target = target
        self.drive_motor.set_control(self.velocity_request.with_velocity(target.speed / WHEEL_CIRCUMFERENCE))
        self.steer_motor.set_control(self.position_request.with_position(target.angle.radians() / math.tau))

    def set_volts(self, volts: float) -> None:
        """Roll straight ahead with this voltage: for characterization."""
        self.drive_motor.set_control(self.voltage_request.with_output(volts))
        self.steer_motor.set_control(self.position_request.with_position(0))

    def stop(self) -> None:
        """Neither roll nor turn."""
        self.target = SwerveModuleState(0, self.angle())
        self.drive_motor.set_control(self.neutral_request)
        self.steer_motor.set_control(self.neutral_request)
