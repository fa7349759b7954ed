"""The elevator: a motor that winds a cable, an encoder on its drum, a limit switch at the bottom."""

import math

import wpilib
import wpilib_drivers
from wpimath import ElevatorFeedforward, ProfiledPIDController, TrapezoidProfile

LOWEST = 0.0  # metres
HIGHEST = 1.4
DRUM_RADIUS = 0.025
COUNTS_PER_TURN = 4096


class Elevator:
    """Move the elevator to a height and hold it there. It must be at the bottom when the robot is switched on."""

    def __init__(self) -> None:
        self.motor = wpilib_drivers.PWMSparkMax(0)
        self.encoder = wpilib.Encoder(0, 1)
        self.encoder.set_distance_per_pulse(math.tau * DRUM_RADIUS / COUNTS_PER_TURN)
        self.bottom_switch = wpilib.DigitalInput(2)  # False while it is pressed

        # The motion profile: at most 1.2 m/s and 2 m/s².
        self.controller = ProfiledPIDController(20.0, 0.0, 0.5, TrapezoidProfile.Constraints(1.2, 2.0))
        # Feedforward in volts: against gravity, and for each m/s. The controller corrects the remaining error.
        self.feedforward = ElevatorFeedforward(0.0, 0.57, 6.5)
        self.controller.set_goal(LOWEST)

    @property
    def height(self) -> float:
        """Return the height in metres."""
        return self.encoder.get_distance()

    @property
    def is_there(self) -> bool:
        """Return whether it has reached its goal."""
        return abs(self.height - self.controller.get_goal().position) < 0.02

    def go_to(self, height: float) -> None:
        """Set the goal to a height, limited to the elevator's range."""
        self.controller.set_goal(max(LOWEST, min(HIGHEST, height)))

    def start_from_here(self) -> None:
        """Hold the current height."""
        self.controller.reset(self.height)
        self.go_to(self.height)

    def move(self) -> None:
        """Set the motor's voltage. Call this every 20 ms."""
        volts = self.controller.calculate(self.height)
        volts += self.feedforward.calculate(self.controller.get_setpoint().velocity)
        if not self.bottom_switch.get():
            volts = max(0.0, volts)  # do not push further down
        self.motor.set_throttle(max(-1.0, min(1.0, volts / 12)))

    def stop(self) -> None:
        """Turn the motor off."""
        self.motor.set_throttle(0)
