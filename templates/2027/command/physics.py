"""Physics of the robot in tests and in the simulator: WPILib's model of a drivetrain.

The numbers describe a typical robot. Replace them with your robot's.
"""

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.encoders import EncoderShaft
from wpilib.simulation import DifferentialDrivetrainSim, PWMMotorControllerSim
from wpimath import DCMotor, Transform2d

from robot import MyRobot

BATTERY = 12.0  # volts


class PhysicsEngine:
    """Move the robot according to its motors. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        drive = robot.container.drive
        self.left_motor = PWMMotorControllerSim(drive.left_motor)
        self.right_motor = PWMMotorControllerSim(drive.right_motor)
        self.left_encoder = EncoderShaft(drive.left_encoder)
        self.right_encoder = EncoderShaft(drive.right_encoder)
        self.drivetrain = DifferentialDrivetrainSim(
            DCMotor.neo(2),  # on each side
            8.46,  # turns of a motor per turn of a wheel
            5.0,  # moment of inertia when it turns, in kg m²
            50.0,  # mass, in kg
            0.0762,  # radius of the wheels, in m
            0.56,  # from the left wheels to the right wheels, in m
        )

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        before = self.drivetrain.get_pose()
        # The right motor is inverted: forward at -1.
        self.drivetrain.set_inputs(self.left_motor.get_throttle() * BATTERY, -self.right_motor.get_throttle() * BATTERY)
        self.drivetrain.update(tm_diff)
        self.physics_controller.move_robot(Transform2d(before, self.drivetrain.get_pose()))
        self.left_encoder.turn_to(self.drivetrain.get_left_position(), self.drivetrain.get_left_velocity())
        self.right_encoder.turn_to(self.drivetrain.get_right_position(), self.drivetrain.get_right_velocity())
