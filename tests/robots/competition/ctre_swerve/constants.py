"""Numbers of the robot: CAN ids, geometry, gains, setpoints. Units are in the names or beside the number."""

import math

from phoenix6.configs import (
    CANcoderConfiguration,
    CurrentLimitsConfigs,
    Slot0Configs,
    TalonFXConfiguration,
)
from phoenix6.signals import FeedbackSensorSourceValue, GravityTypeValue, InvertedValue, NeutralModeValue
from wpimath.geometry import Translation2d


class Can:
    """Ids on the CAN bus. A module's drive and steer motors follow each other: 11 and 12, 21 and 22."""

    PIGEON = 1
    POWER_HUB = 2
    ELEVATOR_LEADER, ELEVATOR_FOLLOWER = 51, 52
    ARM_MOTOR, ARM_ENCODER = 53, 54
    SHOOTER_TOP, SHOOTER_BOTTOM = 61, 62
    INTAKE = 55


class Swerve:
    """The drivetrain: MK4i L2 modules with Kraken X60."""

    WHEEL_RADIUS = 0.0508  # m
    DRIVE_RATIO = 6.75
    STEER_RATIO = 150 / 7
    TRACK = 0.57  # m, between the wheels in both directions
    MASS = 58.0  # kg
    MAX_SPEED = 4.6  # m/s
    MAX_TURNING = 2.2 * math.pi  # rad/s
    ODOMETRY_FREQUENCY = 100  # Hz

    # name, drive id, steer id, encoder id, encoder offset in rotations
    MODULES = (
        ("FrontLeft", 11, 12, 13, 0.123),
        ("FrontRight", 21, 22, 23, -0.341),
        ("RearLeft", 31, 32, 33, 0.052),
        ("RearRight", 41, 42, 43, -0.217),
    )
    LOCATIONS = (
        Translation2d(TRACK / 2, TRACK / 2),
        Translation2d(TRACK / 2, -TRACK / 2),
        Translation2d(-TRACK / 2, TRACK / 2),
        Translation2d(-TRACK / 2, -TRACK / 2),
    )


class Elevator:
    """Two motors on one drum."""

    RATIO = 9.0
    DRUM_RADIUS = 0.0222  # m
    CARRIAGE_MASS = 6.0  # kg
    MAX_HEIGHT = 1.2  # m
    MAX_VELOCITY, MAX_ACCELERATION = 1.8, 6.0  # m/s, m/s²
    STOWED, INTAKE, SCORE_LOW, SCORE_HIGH = 0.0, 0.05, 0.45, 1.1  # m


class Arm:
    """One motor; 0 is horizontal, and up is positive."""

    RATIO = 60.0
    LENGTH = 0.5  # m
    MASS = 3.5  # kg
    MAX_VELOCITY, MAX_ACCELERATION = 5.0, 12.0  # rad/s, rad/s²
    STOWED, INTAKE, SCORE = math.radians(80), math.radians(-20), math.radians(35)


class Shooter:
    """Two wheels, each with its own motor."""

    INERTIA = 0.004  # kg m²
    TOP, BOTTOM = 60.0, 52.0  # rotations per second
    TOLERANCE = 3.0


LED_COUNT = 60


def _limits(stator: float, supply: float) -> CurrentLimitsConfigs:
    return (
        CurrentLimitsConfigs()
        .with_stator_current_limit(stator)
        .with_stator_current_limit_enable(True)
        .with_supply_current_limit(supply)
        .with_supply_current_limit_enable(True)
    )


def drive_config() -> TalonFXConfiguration:
    """Velocity of the wheel in rotations per second, in slot 0."""
    config = TalonFXConfiguration()
    config.motor_output.neutral_mode = NeutralModeValue.BRAKE
    config.feedback.sensor_to_mechanism_ratio = Swerve.DRIVE_RATIO
    config.slot0 = Slot0Configs().with_k_p(0.5).with_k_v(0.12 * Swerve.DRIVE_RATIO)
    config.current_limits = _limits(stator=120, supply=60)
    config.open_loop_ramps.voltage_open_loop_ramp_period = 0.1
    return config


def steer_config(encoder_id: int) -> TalonFXConfiguration:
    """Position of the module in rotations, from the CANcoder fused with the rotor."""
    config = TalonFXConfiguration()
    config.motor_output.inverted = InvertedValue.CLOCKWISE_POSITIVE
    config.motor_output.neutral_mode = NeutralModeValue.BRAKE
    config.feedback.feedback_remote_sensor_id = encoder_id
    config.feedback.feedback_sensor_source = FeedbackSensorSourceValue.FUSED_CANCODER
    config.feedback.rotor_to_sensor_ratio = Swerve.STEER_RATIO
    config.closed_loop_general.continuous_wrap = True
    config.slot0 = Slot0Configs().with_k_p(40).with_k_d(0.4)
    config.current_limits = _limits(stator=60, supply=40)
    return config


def encoder_config(offset: float) -> CANcoderConfiguration:
    """A CANcoder whose magnet was glued in at `offset` rotations."""
    config = CANcoderConfiguration()
    config.magnet_sensor.magnet_offset = offset
    config.magnet_sensor.absolute_sensor_discontinuity_point = 0.5
    return config


def elevator_config() -> TalonFXConfiguration:
    """Rotations of the drum. The robot closes the loop."""
    config = TalonFXConfiguration()
    config.motor_output.neutral_mode = NeutralModeValue.BRAKE
    config.feedback.sensor_to_mechanism_ratio = Elevator.RATIO
    config.current_limits = _limits(stator=80, supply=40)
    config.software_limit_switch.forward_soft_limit_enable = True
    config.software_limit_switch.forward_soft_limit_threshold = Elevator.MAX_HEIGHT / (math.tau * Elevator.DRUM_RADIUS)
    return config


def arm_config() -> TalonFXConfiguration:
    """Rotations of the arm. The robot closes the loop."""
    config = TalonFXConfiguration()
    config.motor_output.neutral_mode = NeutralModeValue.BRAKE
    config.feedback.sensor_to_mechanism_ratio = Arm.RATIO
    config.slot0 = Slot0Configs().with_gravity_type(GravityTypeValue.ARM_COSINE)
    config.current_limits = _limits(stator=60, supply=30)
    return config


def roller_config(k_v: float = 0.0, k_p: float = 0.0) -> TalonFXConfiguration:
    """A wheel on the motor's shaft."""
    config = TalonFXConfiguration()
    config.motor_output.neutral_mode = NeutralModeValue.COAST
    config.slot0 = Slot0Configs().with_k_v(k_v).with_k_p(k_p)
    config.current_limits = _limits(stator=80, supply=40)
    return config
