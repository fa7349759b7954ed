"""One swerve module: a wheel, a motor that drives it, and a motor that turns it."""

import math

import wpilib
import wpilib_drivers
from wpimath import PIDController, Rotation2d, SwerveModulePosition, SwerveModuleVelocity

MAX_SPEED = 4.0  # of the wheel at full power, in m/s
WHEEL_DIAMETER = 0.10  # in metres
DRIVE_GEARING = 6.75  # turns of the drive motor per turn of the wheel
COUNTS_PER_TURN = 1024  # of the encoder on the drive motor


class SwerveModule:
    """A wheel with a speed and a direction."""

    def __init__(self, drive: int, turn: int, drive_encoder: tuple[int, int], angle_encoder: int) -> None:
        self.drive_motor = wpilib_drivers.PWMSparkMax(drive)
        self.turn_motor = wpilib_drivers.PWMSparkMax(turn)

        self.drive_encoder = wpilib.Encoder(*drive_encoder)
        self.drive_encoder.set_distance_per_pulse(math.pi * WHEEL_DIAMETER / DRIVE_GEARING / COUNTS_PER_TURN)

        # An absolute encoder: the wheel's direction in radians. If this is not 0 when the wheel points forward,
        # write its value into the last number.
        self.angle_encoder = wpilib.AnalogEncoder(angle_encoder, math.tau, 0.0)

        self.angle_controller = PIDController(1.0, 0.0, 0.0)  # full power at an error of one radian
        self.angle_controller.enable_continuous_input(-math.pi, math.pi)  # angles one turn apart are the same direction

    @property
    def angle(self) -> Rotation2d:
        """Return the wheel's direction, counter-clockwise from the robot's front."""
        return Rotation2d(self.angle_encoder.get())

    @property
    def position(self) -> SwerveModulePosition:
        """Return how far the wheel has rolled, in metres, and its direction."""
        return SwerveModulePosition(self.drive_encoder.get_distance(), self.angle)

    @property
    def state(self) -> SwerveModuleVelocity:
        """Return the wheel's speed, in m/s, and its direction."""
        return SwerveModuleVelocity(self.drive_encoder.get_rate(), self.angle)

    def set(self, state: SwerveModuleVelocity) -> None:
        """Drive the wheel at a speed, in a direction."""
        if abs(state.velocity) < 0.01:
            self.stop()  # and keep the wheel's direction
            return
        wanted = state.optimize(self.angle)  # drive backwards if the wheel then turns less
        wanted = wanted.cosine_scale(self.angle)  # drive slowly while the wheel points in the wrong direction
        turn = self.angle_controller.calculate(self.angle.radians(), wanted.angle.radians())
        self.drive_motor.set_throttle(within_full_power(wanted.velocity / MAX_SPEED))
        self.turn_motor.set_throttle(within_full_power(turn))

    def stop(self) -> None:
        """Stop both motors."""
        self.drive_motor.set_throttle(0)
        self.turn_motor.set_throttle(0)


def within_full_power(power: float) -> float:
    """Limit the value to a motor's range, from -1 to 1."""
    return max(-1.0, min(1.0, power))
