"""The arm on the elevator: a TalonFX, and a CANcoder on the joint."""

import math

from commands2 import Command, Subsystem
from phoenix6 import BaseStatusSignal
from phoenix6.controls import VoltageOut
from phoenix6.hardware import CANcoder, TalonFX
from wpilib import DriverStation, SmartDashboard
from wpimath.controller import ArmFeedforward, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile

from constants import Arm as Numbers
from constants import Can, arm_config, encoder_config
from subsystems.devices import Connections, configure


class Arm(Subsystem):
    """Holds an angle in radians; 0 is horizontal."""

    def __init__(self) -> None:
        super().__init__()
        self.encoder = CANcoder(Can.ARM_ENCODER)
        configure(self.encoder, encoder_config(0.0))
        self.motor = TalonFX(Can.ARM_MOTOR)
        configure(self.motor, arm_config())
        self.request = VoltageOut(0)
        self.absolute_position = self.encoder.get_absolute_position()
        self.velocity = self.encoder.get_velocity()
        BaseStatusSignal.set_update_frequency_for_all(100, self.absolute_position, self.velocity)
        self.connections = Connections(self.motor, self.encoder)

        self.controller = ProfiledPIDController(
            8.0, 0.0, 0.4, TrapezoidProfile.Constraints(Numbers.MAX_VELOCITY, Numbers.MAX_ACCELERATION)
        )
        self.feedforward = ArmFeedforward(0.0, 0.35, 1.15, 0.02)
        self.goal = Numbers.STOWED

    def angle(self) -> float:
        """Return the angle in radians."""
        return self.absolute_position.value * math.tau

    def at_goal(self) -> bool:
        """Return whether the arm has arrived."""
        return abs(self.angle() - self.goal) < math.radians(4)

    def periodic(self) -> None:
        """Compute and send the voltage, also while disabled: the profile then follows the arm."""
        BaseStatusSignal.refresh_all(self.absolute_position, self.velocity)
        self.connections.update()
        angle = self.angle()
        if DriverStation.isDisabled():
            self.controller.reset(angle, self.velocity.value * math.tau)
        volts = self.controller.calculate(angle, self.goal)
        setpoint = self.controller.getSetpoint()
        volts += self.feedforward.calculate(setpoint.position, setpoint.velocity)
        self.motor.set_control(self.request.with_output(max(-12.0, min(12.0, volts))))
        SmartDashboard.putNumber("Arm/Angle", math.degrees(angle))
        SmartDashboard.putNumber("Arm/Goal", math.degrees(self.goal))

    def move_to(self, angle: float) -> Command:
        """Return a command that ends when the arm is at this angle."""

        def begin() -> None:
            self.goal = angle

        return self.runOnce(begin).andThen(self.run(lambda: None).until(self.at_goal)).withName("Arm")
