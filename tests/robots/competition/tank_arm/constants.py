"""The robot's numbers: ports, sizes, gains, positions. In metres and radians, unless a name says otherwise."""

import math

from wpimath.geometry import Pose2d, Rotation2d, Rotation3d, Transform3d, Translation3d


class Can:
    """Devices on the CAN bus."""

    PDH = 1
    PNEUMATIC_HUB = 1
    LEFT_LEADER = 10
    LEFT_FOLLOWER = 11
    RIGHT_LEADER = 12
    RIGHT_FOLLOWER = 13
    ARM = 20


class Pwm:
    """Motor controllers and lights on PWM."""

    ELEVATOR_LEFT = 0
    ELEVATOR_RIGHT = 1
    WRIST = 2
    ROLLERS = 3
    LEDS = 9


class Dio:
    """Digital sensors."""

    LEFT_ENCODER = (0, 1)
    RIGHT_ENCODER = (2, 3)
    ELEVATOR_ENCODER = (4, 5)
    ELEVATOR_BOTTOM = 6
    ELEVATOR_TOP = 7
    ARM_ENCODER = 8
    PIECE_SENSOR = 9


class Analog:
    """Analog sensors."""

    WRIST_POTENTIOMETER = 0


class Drive:
    """The drivetrain: two NEOs on each side."""

    TRACK_WIDTH = 0.62
    WHEEL_DIAMETER = 0.1524
    GEARING = 8.46
    ENCODER_COUNTS = 2048
    ROBOT_KG = 53.5
    # Metres of the wheels for each turn of a motor.
    METRES_PER_TURN = math.pi * WHEEL_DIAMETER / GEARING
    MAX_SPEED = 3.8
    MAX_ACCELERATION = 2.2
    KS = 0.7
    KV = 2.24
    KA = 0.55
    KP = 1.6
    TURN_KP = 5.0
    TURN_KD = 0.25
    CURRENT_LIMIT = 60
    # Where the robot stands at the start of a match, in the blue alliance's view.
    START = Pose2d(2.2, 4.0, Rotation2d())


class Elevator:
    """A cascade elevator with two Falcons on PWM."""

    GEARING = 12.0
    DRUM_RADIUS = 0.022
    CARRIAGE_KG = 7.5
    ENCODER_COUNTS = 2048
    MAX_HEIGHT = 1.32
    MAX_SPEED = 1.4
    MAX_ACCELERATION = 3.2
    KP = 28.0
    KD = 1.0
    KG = 0.17
    KV = 5.4
    TOLERANCE = 0.02


class Arm:
    """An arm on one NEO, with an absolute encoder on its shaft, and a wrist on a small motor."""

    GEARING = 80.0
    LENGTH = 0.58
    KG = 3.6
    MIN_ANGLE = math.radians(-60)
    MAX_ANGLE = math.radians(100)
    ENCODER_OFFSET = 0.25  # turns that the encoder reads with a horizontal arm
    MAX_SPEED = math.radians(210)
    MAX_ACCELERATION = math.radians(420)
    KP = 9.0
    KD = 0.4
    VOLTS_GRAVITY = 0.55
    KV = 1.6
    TOLERANCE = math.radians(2.5)
    WRIST_RANGE_DEGREES = 270.0
    WRIST_KP = 0.018
    WRIST_TOLERANCE_DEGREES = 4.0


class Positions:
    """Where elevator, arm and wrist go together: metres, degrees, degrees."""

    STOW = (0.0, -55.0, 90.0)
    INTAKE = (0.05, -30.0, 135.0)
    LOW = (0.35, 10.0, 110.0)
    MIDDLE = (0.75, 25.0, 110.0)
    HIGH = (1.25, 55.0, 100.0)


class Vision:
    """The cameras: PhotonVision in front and behind, a Limelight that looks at the goal."""

    FRONT = "front"
    REAR = "rear"
    FRONT_TRANSFORM = Transform3d(Translation3d(0.30, 0.0, 0.35), Rotation3d(0, math.radians(-15), 0))
    REAR_TRANSFORM = Transform3d(Translation3d(-0.30, 0.10, 0.35), Rotation3d(0, math.radians(-15), math.pi))
    LIMELIGHT = "limelight"
    MAX_AMBIGUITY = 0.2
    MAX_DISTANCE = 5.0


class Driver:
    """The gamepads."""

    DRIVER_PORT = 0
    OPERATOR_PORT = 1
    DEADBAND = 0.08
    SLOW = 0.4


LED_COUNT = 60
