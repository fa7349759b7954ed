"""The arm: a motor that turns it, and an encoder on its axle that knows its angle also after the robot was off."""

import math

import wpilib
from wpimath.controller import ArmFeedforward, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile

LOWEST = math.radians(-85)  # from level; up is positive
HIGHEST = math.radians(85)

# The encoder reads from 0 to a full turn. When the arm is level, it is to read half a turn: this far from both ends.
READS_WHEN_LEVEL = math.pi


class Arm:
    """Goes to angles, and holds them."""

    def __init__(self) -> None:
        self.motor = wpilib.PWMSparkMax(1)
        self.encoder = wpilib.DutyCycleEncoder(3, math.tau, 0.0)

        # Gets going and slows down gently: at most 3 rad/s, 6 rad/s².
        self.controller = ProfiledPIDController(12.0, 0.0, 0.3, TrapezoidProfile.Constraints(3.0, 6.0))
        # What it takes by itself, in volts: against gravity when it is level, and for each rad/s.
        self.feedforward = ArmFeedforward(0.0, 0.41, 2.0)

    @property
    def angle(self) -> float:
        """Its angle, in radians."""
        return self.encoder.get() - READS_WHEN_LEVEL

    @property
    def is_there(self) -> bool:
        """Whether it is where it was told to go."""
        return abs(self.angle - self.controller.getGoal().position) < 0.03

    def go_to(self, angle: float) -> None:
        """Go to an angle from now on; further than it can, it stays at the end."""
        self.controller.setGoal(max(LOWEST, min(HIGHEST, angle)))

    def start_from_here(self) -> None:
        """Hold the angle that it has now."""
        self.controller.reset(self.angle)
        self.go_to(self.angle)

    def move(self) -> None:
        """Tell the motor what brings it there; to be called every 20 ms."""
        volts = self.controller.calculate(self.angle)
        setpoint = self.controller.getSetpoint()
        volts += self.feedforward.calculate(setpoint.position, setpoint.velocity)
        self.motor.set(max(-1.0, min(1.0, volts / 12)))

    def stop(self) -> None:
        """Let go."""
        self.motor.set(0)
