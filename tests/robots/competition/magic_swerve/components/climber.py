"""The hook that lifts the robot: an elevator with a brake."""

import wpilib
from constants import CLIMBER_TRAVEL
from magicbot import feedback, tunable
from wpimath.controller import ElevatorFeedforward, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile


class Climber:
    """Two motors, an encoder, a switch at the bottom, and a brake that air opens."""

    left: wpilib.PWMSparkMax
    encoder: wpilib.Encoder
    bottom: wpilib.DigitalInput
    brake: wpilib.Solenoid

    kp = tunable(55.0)
    kg = tunable(0.35)

    def setup(self) -> None:
        """Create the controllers."""
        self.pid = ProfiledPIDController(self.kp, 0, 1.0, TrapezoidProfile.Constraints(0.7, 2.0))
        self.feedforward = ElevatorFeedforward(kS=0.05, kG=self.kg, kV=7.0)
        self.goal: float | None = None
        self.homed = False

    def on_enable(self) -> None:
        """Stay where the hook is."""
        self.pid.reset(self.encoder.getDistance())
        self.goal = None

    def extend(self) -> None:
        """Raise the hook."""
        self.goal = CLIMBER_TRAVEL - 0.04

    def retract(self) -> None:
        """Lower the hook, or lift the robot."""
        self.goal = 0.01

    def hold(self) -> None:
        """Brake."""
        self.goal = None

    def at_goal(self) -> bool:
        """Return whether the hook is where it was sent."""
        return self.goal is not None and abs(self.encoder.getDistance() - self.goal) < 0.015

    @feedback
    def get_height(self) -> float:
        return self.encoder.getDistance()

    @feedback
    def get_homed(self) -> bool:
        return self.homed

    def check_bottom(self) -> None:
        """The switch says where zero is, also while disabled."""
        if not self.bottom.get():
            if not self.homed:
                self.encoder.reset()
            self.homed = True

    def execute(self) -> None:
        """Move the hook, or brake."""
        self.brake.set(self.goal is not None)
        height = self.encoder.getDistance()
        if self.goal is None:
            self.left.stopMotor()
            self.pid.reset(height)
            return
        self.pid.setP(self.kp)
        volts = self.pid.calculate(height, self.goal)
        volts += self.feedforward.calculate(self.pid.getSetpoint().velocity)
        if not self.bottom.get():
            volts = max(volts, 0)  # not below the bottom
        self.left.setVoltage(volts)

    def on_disable(self) -> None:
        """Stop, and close the brake."""
        self.left.stopMotor()
        self.brake.set(False)
