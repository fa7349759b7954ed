"""Every number of the robot in one place: CAN ids, dimensions, gains."""

import math

from wpimath.geometry import Rotation2d, Transform3d, Translation2d
from wpimath.kinematics import SwerveDrive4Kinematics


class CanIds:
    """Which device has which CAN id."""

    POWER_HUB = 1
    # Front left, front right, back left, back right
    DRIVING = (11, 13, 15, 17)
    TURNING = (12, 14, 16, 18)
    ELEVATOR_LEADER = 21
    ELEVATOR_FOLLOWER = 22
    TOP_FLYWHEEL = 31
    BOTTOM_FLYWHEEL = 32
    FEEDER = 33
    INTAKE_PIVOT = 41
    INTAKE_ROLLERS = 42
    CLIMBER = 51

    NAMES = {  # in the log
        11: "FrontLeftDriving",
        12: "FrontLeftTurning",
        13: "FrontRightDriving",
        14: "FrontRightTurning",
        15: "BackLeftDriving",
        16: "BackLeftTurning",
        17: "BackRightDriving",
        18: "BackRightTurning",
        21: "ElevatorLeader",
        22: "ElevatorFollower",
        31: "TopFlywheel",
        32: "BottomFlywheel",
        33: "Feeder",
        41: "IntakePivot",
        42: "IntakeRollers",
        51: "Climber",
    }


class Ports:
    """What is plugged into the roboRIO."""

    FEEDER_BEAM = 0  # DIO, low while a piece blocks it
    ELEVATOR_BOTTOM_SWITCH = 1  # DIO, low while pressed
    LED_STRIP = 9  # PWM


class Controllers:
    """USB ports at the driver station."""

    DRIVER = 0
    OPERATOR = 1
    DEADBAND = 0.08


class Drive:
    """A swerve drive with four MAXSwerve modules."""

    TRACK_WIDTH = 0.622  # metres between the left and the right wheels
    WHEEL_BASE = 0.622
    MODULE_NAMES = ("FrontLeft", "FrontRight", "BackLeft", "BackRight")
    MODULE_POSITIONS = (
        Translation2d(WHEEL_BASE / 2, TRACK_WIDTH / 2),
        Translation2d(WHEEL_BASE / 2, -TRACK_WIDTH / 2),
        Translation2d(-WHEEL_BASE / 2, TRACK_WIDTH / 2),
        Translation2d(-WHEEL_BASE / 2, -TRACK_WIDTH / 2),
    )
    KINEMATICS = SwerveDrive4Kinematics(*MODULE_POSITIONS)
    # The modules are mounted a quarter turn apart, so their encoders are, too.
    ANGULAR_OFFSETS = (
        Rotation2d(-math.pi / 2),
        Rotation2d(0),
        Rotation2d(math.pi),
        Rotation2d(math.pi / 2),
    )

    WHEEL_DIAMETER = 0.0762  # metres
    DRIVING_REDUCTION = (45 * 22) / (14 * 15)
    TURNING_REDUCTION = 9424 / 203
    NEO_FREE_SPEED = 5676 / 60  # rotations per second
    FREE_SPEED = NEO_FREE_SPEED * WHEEL_DIAMETER * math.pi / DRIVING_REDUCTION  # metres per second

    DRIVING_KP = 0.04
    TURNING_KP = 1.0
    DRIVING_CURRENT_LIMIT = 50  # amperes
    TURNING_CURRENT_LIMIT = 20

    MAX_SPEED = 4.4  # metres per second
    MAX_ROTATION = math.tau  # radians per second
    MAX_ACCELERATION = 9.0  # metres per second squared
    SLOW_FACTOR = 0.35

    AUTO_TRANSLATION_KP = 5.0
    AUTO_ROTATION_KP = 5.0
    AIM_KP = 6.0


class Robot:
    """The robot as a whole."""

    MASS = 52.0  # kilograms, with bumpers and battery


class Elevator:
    """Two NEOs lift the carriage with the shooter."""

    REDUCTION = 12.0
    DRUM_RADIUS = 0.0223  # metres
    CARRIAGE_MASS = 7.5  # kilograms
    MIN_HEIGHT = 0.0  # metres
    MAX_HEIGHT = 1.2
    STOWED = 0.0
    HUB = 0.55
    TOP = 1.1
    MAX_SPEED = 1.4
    MAX_ACCELERATION = 4.0
    TOLERANCE = 0.02
    KP, KI, KD = 45.0, 0.0, 0.5  # volts per metre, ...
    KS, KG, KV, KA = 0.0, 0.35, 4.55, 0.1  # volts


class Shooter:
    """Two flywheels and a feeder."""

    REDUCTION = 1.0
    SPIN_UP_RPM = 4200.0
    IDLE_RPM = 1200.0
    TOLERANCE_RPM = 150.0
    KP = 0.0002
    FEED_POWER = 0.8
    FEED_SECONDS = 0.5
    INERTIA = 0.0032  # of one flywheel, in kg m^2


class Intake:
    """An arm with rollers that folds out over the bumper."""

    REDUCTION = 60.0
    LENGTH = 0.35  # metres
    MASS = 3.0  # kilograms
    STOWED = math.radians(100)  # from horizontal
    DEPLOYED = math.radians(-5)
    MIN_ANGLE = math.radians(-10)
    MAX_ANGLE = math.radians(110)
    MAX_SPEED = math.radians(360)
    MAX_ACCELERATION = math.radians(900)
    TOLERANCE = math.radians(4)
    KP, KI, KD = 8.0, 0.0, 0.2  # volts per radian, ...
    KS, KG, KV = 0.0, 0.33, 1.27
    ROLLER_POWER = 0.7


class Climber:
    """A winch with a hook."""

    REDUCTION = 45.0
    DRUM_RADIUS = 0.016
    MAX_TRAVEL = 0.6  # metres
    UP_POWER = 0.9
    DOWN_POWER = -1.0


class Vision:
    """A camera that publishes the robot's pose in NetworkTables."""

    TABLE = "limelight"
    ROBOT_TO_CAMERA = Transform3d()
    STANDARD_DEVIATIONS = (0.4, 0.4, 9999.0)  # metres, metres, radians: the gyro knows better
    STALE_SECONDS = 0.5
    MAX_JUMP = 1.0  # metres: while enabled, measurements farther off are ignored


class Leds:
    """A strip of LEDs around the shooter."""

    LENGTH = 60
    SPACING = 1 / 60  # metres


class Field:
    """Where things are, for a robot of the blue alliance."""

    HUB = Translation2d(4.63, 4.03)
    LENGTH = 16.54
    WIDTH = 8.07
