"""The arm: a motor that turns it, and an absolute encoder on its axle."""

import math

import wpilib
import wpilib_drivers
from wpimath import ArmFeedforward, ProfiledPIDController, TrapezoidProfile

LOWEST = math.radians(-85)  # from level; up is positive
HIGHEST = math.radians(85)

# The encoder reads from 0 to a full turn. It must read half a turn when the arm is level, far from both ends.
READS_WHEN_LEVEL = math.pi


class Arm:
    """Move the arm to an angle and hold it there."""

    def __init__(self) -> None:
        self.motor = wpilib_drivers.PWMSparkMax(1)
        self.encoder = wpilib.DutyCycleEncoder(3, math.tau, 0.0)

        # The motion profile: at most 3 rad/s and 6 rad/s².
        self.controller = ProfiledPIDController(12.0, 0.0, 0.3, TrapezoidProfile.Constraints(3.0, 6.0))
        # Feedforward in volts: against gravity when the arm is level, and for each rad/s.
        self.feedforward = ArmFeedforward(0.0, 0.41, 2.0)

    @property
    def angle(self) -> float:
        """Return the angle in radians."""
        return self.encoder.get() - READS_WHEN_LEVEL

    @property
    def is_there(self) -> bool:
        """Return whether it has reached its goal."""
        return abs(self.angle - self.controller.get_goal().position) < 0.03

    def go_to(self, angle: float) -> None:
        """Set the goal to an angle, limited to the arm's range."""
        self.controller.set_goal(max(LOWEST, min(HIGHEST, angle)))

    def start_from_here(self) -> None:
        """Hold the current angle."""
        self.controller.reset(self.angle)
        self.go_to(self.angle)

    def move(self) -> None:
        """Set the motor's voltage. Call this every 20 ms."""
        volts = self.controller.calculate(self.angle)
        setpoint = self.controller.get_setpoint()
        volts += self.feedforward.calculate(setpoint.position, setpoint.velocity)
        self.motor.set_throttle(max(-1.0, min(1.0, volts / 12)))

    def stop(self) -> None:
        """Turn the motor off."""
        self.motor.set_throttle(0)
