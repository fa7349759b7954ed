"""Physics of the robot in tests and in the simulator: a drivetrain without inertia, and its encoders.

The numbers describe a typical robot. Replace them with your robot's. The IMU turns with the robot.
"""

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.drivetrains import TwoMotorDrivetrain
from pyfrc.physics.encoders import EncoderShaft
from wpilib.simulation import PWMMotorControllerSim

from robot import MyRobot


class PhysicsEngine:
    """Move the robot according to its motors. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.left_motor = PWMMotorControllerSim(robot.left_motor)
        self.right_motor = PWMMotorControllerSim(robot.right_motor)
        self.left_encoder = EncoderShaft(robot.left_encoder)
        self.right_encoder = EncoderShaft(robot.right_encoder)
        self.left_rolled = self.right_rolled = 0.0  # in metres
        # Wheels 2 ft apart; 12 ft/s at full power.
        self.drivetrain = TwoMotorDrivetrain(x_wheelbase=2, speed=12)

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        speeds = self.drivetrain.calculate(self.left_motor.get_throttle(), self.right_motor.get_throttle())
        self.physics_controller.drive(speeds, tm_diff)

        wheels = self.drivetrain.wheelSpeeds  # in metres per second
        self.left_rolled += wheels.left * tm_diff
        self.right_rolled += wheels.right * tm_diff
        self.left_encoder.turn_to(self.left_rolled, wheels.left)
        self.right_encoder.turn_to(self.right_rolled, wheels.right)
