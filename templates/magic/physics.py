"""Physics of the robot in tests and in the simulator: a drivetrain, and the inertia of the shooter's wheel.

The numbers describe a typical robot. Replace them with your robot's.
"""

import math

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.drivetrains import TwoMotorDrivetrain
from wpilib.simulation import EncoderSim, FlywheelSim, PWMSim
from wpimath.system.plant import DCMotor, LinearSystemId

from robot import MyRobot


class PhysicsEngine:
    """Move the robot and spin the wheel according to the motors. Created after the robot's devices."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.left_motor = PWMSim(robot.drivetrain_left_motor.getChannel())
        self.right_motor = PWMSim(robot.drivetrain_right_motor.getChannel())
        self.drivetrain = TwoMotorDrivetrain(x_wheelbase=2, speed=12)  # in feet, and in ft/s

        self.wheel_motor = PWMSim(robot.shooter_wheel_motor.getChannel())
        self.wheel_encoder = EncoderSim(robot.shooter_wheel_encoder)
        motor = DCMotor.NEO(1)
        # Inertia in kg m², and as many turns of the motor as of the wheel.
        self.wheel = FlywheelSim(LinearSystemId.flywheelSystem(motor, 0.004, 1.0), motor)
        self.turns = 0.0

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        speeds = self.drivetrain.calculate(self.left_motor.getSpeed(), self.right_motor.getSpeed())
        self.physics_controller.drive(speeds, tm_diff)

        self.wheel.setInputVoltage(self.wheel_motor.getSpeed() * 12)
        self.wheel.update(tm_diff)
        turns_a_second = self.wheel.getAngularVelocity() / math.tau
        self.turns += turns_a_second * tm_diff
        self.wheel_encoder.setDistance(self.turns)
        self.wheel_encoder.setRate(turns_a_second)
