"""The elevator: two TalonFX on one drum, moved along a profile by the robot's own controller."""

import math

from commands2 import Command, Subsystem
from phoenix6 import BaseStatusSignal
from phoenix6.controls import Follower, VoltageOut
from phoenix6.hardware import TalonFX
from phoenix6.signals import MotorAlignmentValue
from wpilib import DigitalInput, DriverStation, SmartDashboard
from wpimath.controller import ElevatorFeedforward, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile

from constants import Can, elevator_config
from constants import Elevator as Numbers
from subsystems.devices import Connections, configure

METRES_PER_ROTATION = math.tau * Numbers.DRUM_RADIUS


class Elevator(Subsystem):
    """Holds a height in metres."""

    def __init__(self) -> None:
        super().__init__()
        self.leader = TalonFX(Can.ELEVATOR_LEADER)
        self.follower = TalonFX(Can.ELEVATOR_FOLLOWER)
        for motor in (self.leader, self.follower):
            configure(motor, elevator_config())
        self.follower.set_control(Follower(Can.ELEVATOR_LEADER, MotorAlignmentValue.OPPOSED))
        self.request = VoltageOut(0)
        # A limit switch pulls its input to ground: True means that it is not pressed.
        self.bottom_switch = DigitalInput(0)
        self.position = self.leader.get_position()
        self.velocity = self.leader.get_velocity()
        BaseStatusSignal.set_update_frequency_for_all(100, self.position, self.velocity)
        self.connections = Connections(self.leader, self.follower)

        self.controller = ProfiledPIDController(
            40.0, 0.0, 1.0, TrapezoidProfile.Constraints(Numbers.MAX_VELOCITY, Numbers.MAX_ACCELERATION)
        )
        self.controller.setTolerance(0.02)
        self.feedforward = ElevatorFeedforward(0.0, 0.12, 6.6, 0.05)
        self.goal = Numbers.STOWED

    def height(self) -> float:
        """Return the height in metres."""
        return self.position.value * METRES_PER_ROTATION

    def at_goal(self) -> bool:
        """Return whether the elevator has arrived."""
        return abs(self.height() - self.goal) < 0.03

    def periodic(self) -> None:
        """Compute and send the voltage, also while disabled: the profile then follows the carriage."""
        BaseStatusSignal.refresh_all(self.position, self.velocity)
        self.connections.update()
        height, velocity = self.height(), self.velocity.value * METRES_PER_ROTATION
        if DriverStation.isDisabled():
            self.controller.reset(height, velocity)
        volts = self.controller.calculate(height, self.goal)
        volts += self.feedforward.calculate(self.controller.getSetpoint().velocity)
        if not self.bottom_switch.get() and volts < 0:
            volts = 0.0
        self.leader.set_control(self.request.with_output(max(-12.0, min(12.0, volts))))
        SmartDashboard.putNumber("Elevator/Height", height)
        SmartDashboard.putNumber("Elevator/Goal", self.goal)

    def move_to(self, height: float) -> Command:
        """Return a command that ends when the elevator is at this height."""

        def begin() -> None:
            self.goal = min(max(height, 0.0), Numbers.MAX_HEIGHT)

        return self.runOnce(begin).andThen(self.run(lambda: None).until(self.at_goal)).withName(f"Elevator {height}")
