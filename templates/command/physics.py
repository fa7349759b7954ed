"""Physics of the robot in tests and in the simulator: WPILib's model of a drivetrain.

The numbers describe a typical robot. Replace them with your robot's.
"""

from pyfrc.physics.core import PhysicsInterface
from wpilib.simulation import DifferentialDrivetrainSim, EncoderSim, PWMSim
from wpimath.geometry import Transform2d
from wpimath.system.plant import DCMotor

from robot import MyRobot

BATTERY = 12.0  # volts


class PhysicsEngine:
    """Move the robot according to its motors. Created after robotInit."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        drive = robot.container.drive
        self.left_motor = PWMSim(drive.left_motor.getChannel())
        self.right_motor = PWMSim(drive.right_motor.getChannel())
        self.left_encoder = EncoderSim(drive.left_encoder)
        self.right_encoder = EncoderSim(drive.right_encoder)
        self.drivetrain = DifferentialDrivetrainSim(
            DCMotor.NEO(2),  # on each side
            8.46,  # turns of a motor per turn of a wheel
            5.0,  # moment of inertia when it turns, in kg m²
            50.0,  # mass, in kg
            0.0762,  # radius of the wheels, in m
            0.56,  # from the left wheels to the right wheels, in m
        )
        physics_controller.add_device_gyro_channel("adxrs450_spi_0_angle")  # turns with the robot

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        before = self.drivetrain.getPose()
        # The right motor is inverted: forward at -1.
        self.drivetrain.setInputs(self.left_motor.getSpeed() * BATTERY, -self.right_motor.getSpeed() * BATTERY)
        self.drivetrain.update(tm_diff)
        self.physics_controller.move_robot(Transform2d(before, self.drivetrain.getPose()))
        self.left_encoder.setDistance(self.drivetrain.getLeftPosition())
        self.right_encoder.setDistance(self.drivetrain.getRightPosition())
