"""Where everything is plugged in, and what was measured on the robot. Metres, radians, seconds and volts."""

import math

from wpimath.geometry import Pose2d, Rotation2d, Translation2d

# -- CAN -------------------------------------------------------------------------------------------------------------
#: Drive motor, steering motor, absolute encoder (DIO), its reading with the wheel straight ahead (turns), position.
MODULES = {
    "front left": (1, 2, 0, 0.125, Translation2d(0.27, 0.27)),
    "front right": (3, 4, 1, 0.480, Translation2d(0.27, -0.27)),
    "back left": (5, 6, 2, 0.873, Translation2d(-0.27, 0.27)),
    "back right": (7, 8, 3, 0.301, Translation2d(-0.27, -0.27)),
}
SHOOTER_LEFT, SHOOTER_RIGHT = 9, 10
INTAKE_ROLLER = 11
POWER_DISTRIBUTION = 1
PNEUMATICS = 1

# -- roboRIO ---------------------------------------------------------------------------------------------------------
PWM_INTAKE_PIVOT, PWM_INDEXER, PWM_CLIMBER_LEFT, PWM_CLIMBER_RIGHT, PWM_HOOD, PWM_LEDS = 0, 1, 2, 3, 4, 9
DIO_CLIMBER_A, DIO_CLIMBER_B, DIO_CLIMBER_BOTTOM, DIO_INDEXER_ENTRY, DIO_INDEXER_EXIT = 4, 5, 6, 7, 8
ANALOG_INTAKE_PIVOT = 0
SOLENOID_CLIMBER_BRAKE = 0
LED_COUNT = 60

# -- drive -----------------------------------------------------------------------------------------------------------
WHEEL_CIRCUMFERENCE = 4 * 0.0254 * math.pi
DRIVE_GEARING = 6.75
STEER_GEARING = 150 / 7
MAX_SPEED = 4.3
MAX_ACCELERATION = 6.0
MAX_TURN_RATE = 2 * math.pi
DRIVE_KS, DRIVE_KV, DRIVE_KA = 0.12, 2.65, 0.25

# -- intake ----------------------------------------------------------------------------------------------------------
INTAKE_STOWED = math.radians(95)
INTAKE_DEPLOYED = math.radians(-5)
INTAKE_GEARING = 60.0
INTAKE_LENGTH = 0.35
INTAKE_MASS = 3.2
#: The potentiometer turns once over its 5 V.
INTAKE_POTENTIOMETER_RANGE = math.radians(270)
INTAKE_POTENTIOMETER_OFFSET = math.radians(-30)

# -- shooter ---------------------------------------------------------------------------------------------------------
#: Distance from the hub (m): speed of the wheels (rpm), position of the hood (0 to 1).
SHOTS = {1.5: (2600.0, 0.10), 2.5: (3000.0, 0.28), 3.5: (3450.0, 0.45), 4.5: (4000.0, 0.60), 6.0: (4800.0, 0.80)}
SHOOTER_KS, SHOOTER_KV = 0.18, 0.00205

# -- climber ---------------------------------------------------------------------------------------------------------
CLIMBER_GEARING = 12.0
CLIMBER_DRUM = 0.019
CLIMBER_TRAVEL = 0.62
CLIMBER_COUNTS = 2048
CLIMBER_MASS = 4.5

# -- field, as the blue alliance sees it -----------------------------------------------------------------------------
FIELD_LENGTH, FIELD_WIDTH = 16.54, 8.07
HUB = Translation2d(4.63, FIELD_WIDTH / 2)
STARTS = {
    "Left": Pose2d(3.55, 6.4, Rotation2d()),
    "Center": Pose2d(3.30, FIELD_WIDTH / 2, Rotation2d()),
    "Right": Pose2d(3.55, 1.7, Rotation2d()),
}
DEPOT = Pose2d(0.75, 5.95, Rotation2d.fromDegrees(180))
TOWER = Pose2d(1.60, 3.75, Rotation2d.fromDegrees(180))
