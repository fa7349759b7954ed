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
    PWMSim,
    RoboRioSim,
    SingleJointedArmSim,
)
from wpimath.system.plant import DCMotor

import arm
import elevator
from robot import MyRobot

ARM_LENGTH = 0.6  # metres
ARM_MASS = 3.0  # kg


class PhysicsEngine:
    """Move both mechanisms according to their motors. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.elevator_motor = PWMSim(robot.elevator.motor)
        self.elevator_encoder = EncoderShaft(robot.elevator.encoder)
        self.bottom_switch = DIOSim(robot.elevator.bottom_switch)
        self.elevator = ElevatorSim(
            DCMotor.NEO(2),
            8.0,  # turns of a motor for one of the drum
            8.0,  # mass of the carriage, in kg
            elevator.DRUM_RADIUS,
            elevator.LOWEST,
            elevator.HIGHEST,
            True,  # with gravity
            elevator.LOWEST,  # where it starts
        )

        self.arm_motor = PWMSim(robot.arm.motor)
        self.arm_encoder = DutyCycleEncoderSim(robot.arm.encoder)
        self.arm = SingleJointedArmSim(
            DCMotor.NEO(1),
            100.0,  # turns of the motor for one of the arm
            SingleJointedArmSim.estimateMOI(ARM_LENGTH, ARM_MASS),
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
        self.elevator.setInputVoltage(self.elevator_motor.getSpeed() * self.battery)
        self.elevator.update(tm_diff)
        self.arm.setInputVoltage(self.arm_motor.getSpeed() * self.battery)
        self.arm.update(tm_diff)

        # The motors' current lowers the battery's voltage.
        self.battery = BatterySim.calculate([self.elevator.getCurrentDraw(), self.arm.getCurrentDraw()])
        RoboRioSim.setVInVoltage(self.battery)
        self.measure()

    def measure(self) -> None:
        """Set the sensors to the positions of both mechanisms."""
        self.elevator_encoder.turn_to(self.elevator.getPosition(), self.elevator.getVelocity())
        self.bottom_switch.setValue(self.elevator.getPosition() > 0.005)  # pressed in the last 5 mm
        self.arm_encoder.set(self.arm.getAngle() + arm.READS_WHEN_LEVEL)
