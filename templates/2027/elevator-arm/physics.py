"""Physics of the robot in tests and in the simulator: gravity, and WPILib's models of both mechanisms.

The numbers describe a typical robot. Replace them with your robot's.
"""

import math

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.encoders import EncoderShaft
from wpilib.simulation import (
    BatterySim,
    DIOSim,
    DutyCycleEncoderSim,
    ElevatorSim,
    PWMMotorControllerSim,
    RoboRioSim,
    SingleJointedArmSim,
)
from wpimath import DCMotor

import arm
import elevator
from robot import MyRobot

ARM_LENGTH = 0.6  # metres
ARM_MASS = 3.0  # kg


class PhysicsEngine:
    """Move both mechanisms according to their motors. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.elevator_motor = PWMMotorControllerSim(robot.elevator.motor)
        self.elevator_encoder = EncoderShaft(robot.elevator.encoder)
        self.bottom_switch = DIOSim(robot.elevator.bottom_switch)
        self.elevator = ElevatorSim(
            DCMotor.neo(2),
            8.0,  # turns of a motor for one of the drum
            8.0,  # mass of the carriage, in kg
            elevator.DRUM_RADIUS,
            elevator.LOWEST,
            elevator.HIGHEST,
            True,  # with gravity
            elevator.LOWEST,  # where it starts
        )

        self.arm_motor = PWMMotorControllerSim(robot.arm.motor)
        self.arm_encoder = DutyCycleEncoderSim(robot.arm.encoder)
        self.arm = SingleJointedArmSim(
            DCMotor.neo(1),
            100.0,  # turns of the motor for one of the arm
            SingleJointedArmSim.estimate_moi(ARM_LENGTH, ARM_MASS),
            ARM_LENGTH,
            arm.LOWEST,
            arm.HIGHEST,
            True,  # with gravity
            math.radians(-80),  # where it starts
        )
        self.battery = 12.0
        self.measure()

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        self.elevator.set_input_voltage(self.elevator_motor.get_throttle() * self.battery)
        self.elevator.update(tm_diff)
        self.arm.set_input_voltage(self.arm_motor.get_throttle() * self.battery)
        self.arm.update(tm_diff)

        # The motors' current lowers the battery's voltage.
        self.battery = BatterySim.calculate([self.elevator.get_current_draw(), self.arm.get_current_draw()])
        RoboRioSim.set_vin_voltage(self.battery)
        self.measure()

    def measure(self) -> None:
        """Set the sensors to the positions of both mechanisms."""
        self.elevator_encoder.turn_to(self.elevator.get_position(), self.elevator.get_velocity())
        self.bottom_switch.set_value(self.elevator.get_position() > 0.005)  # pressed in the last 5 mm
        self.arm_encoder.set(self.arm.get_angle() + arm.READS_WHEN_LEVEL)
