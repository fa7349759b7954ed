"""Physics of the robot in tests and in the simulator: mecanum wheels and their encoders.

The gyro turns with the robot. The numbers describe a typical robot. Replace them with your robot's.
"""

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.drivetrains import MecanumDrivetrain
from pyfrc.physics.encoders import EncoderShaft
from pyfrc.physics.units import units
from wpilib.simulation import PWMSim

from robot import MyRobot

TRACK_WIDTH = 22 * units.inch  # from the left wheels to the right wheels
WHEEL_BASE = 24 * units.inch  # from the rear wheels to the front wheels
MAX_SPEED = 10 * units.fps  # at full power
METRES_PER_SECOND = MAX_SPEED.to(units.metre / units.second).magnitude


class PhysicsEngine:
    """Move the robot according to its motors. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        # In the order in which calculate() takes them.
        self.motors = [
            PWMSim(motor) for motor in (robot.front_left, robot.rear_left, robot.front_right, robot.rear_right)
        ]
        self.drivetrain = MecanumDrivetrain(x_wheelbase=TRACK_WIDTH, y_wheelbase=WHEEL_BASE, speed=MAX_SPEED)
        self.encoders = [EncoderShaft(encoder) for encoder in robot.encoders]
        self.rolled = [0.0] * 4  # how far each wheel has rolled, in metres
        physics_controller.add_device_gyro_channel("adxrs450_spi_0_angle")  # turns with the robot

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        front_left, rear_left, front_right, rear_right = (motor.getSpeed() for motor in self.motors)
        speeds = self.drivetrain.calculate(front_left, rear_left, front_right, rear_right)
        self.physics_controller.drive(speeds, tm_diff)
        # The right motors are inverted: forward at -1.
        for wheel, power in enumerate((front_left, rear_left, -front_right, -rear_right)):
            speed = power * METRES_PER_SECOND
            self.rolled[wheel] += speed * tm_diff
            self.encoders[wheel].turn_to(self.rolled[wheel], speed)
