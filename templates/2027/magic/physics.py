"""Physics of the robot in tests and in the simulator: a drivetrain, and the inertia of the shooter's wheel.

The numbers describe a typical robot. Replace them with your robot's.
"""

import math

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.drivetrains import TwoMotorDrivetrain
from pyfrc.physics.encoders import EncoderShaft
from wpilib.simulation import FlywheelSim, PWMMotorControllerSim
from wpimath import DCMotor, Models

from robot import MyRobot


class PhysicsEngine:
    """Move the robot and spin the wheel according to the motors. Created after the robot's devices."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.left_motor = PWMMotorControllerSim(robot.drivetrain_left_motor)
        self.right_motor = PWMMotorControllerSim(robot.drivetrain_right_motor)
        self.drivetrain = TwoMotorDrivetrain(x_wheelbase=2, speed=12)  # in feet, and in ft/s

        self.wheel_motor = PWMMotorControllerSim(robot.shooter_wheel_motor)
        self.wheel_encoder = EncoderShaft(robot.shooter_wheel_encoder)
        motor = DCMotor.neo(1)
        # Inertia in kg m², and as many turns of the motor as of the wheel.
        self.wheel = FlywheelSim(Models.flywheel_from_physical_constants(motor, 0.004, 1.0), motor)
        self.turns = 0.0

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        speeds = self.drivetrain.calculate(self.left_motor.get_throttle(), self.right_motor.get_throttle())
        self.physics_controller.drive(speeds, tm_diff)

        self.wheel.set_input_voltage(self.wheel_motor.get_throttle() * 12)
        self.wheel.update(tm_diff)
        turns_a_second = self.wheel.get_angular_velocity() / math.tau
        self.turns += turns_a_second * tm_diff
        self.wheel_encoder.turn_to(self.turns, turns_a_second)
