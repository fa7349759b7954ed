"""What the robot's surroundings are in tests and in the simulator: here, the floor that it drives on."""

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.drivetrains import TwoMotorDrivetrain
from wpilib.simulation import PWMSim

from robot import MyRobot


class PhysicsEngine:
    """Made when the robot's robotInit is over; moves the robot as its motors say."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.left_motor = PWMSim(robot.left_motor.getChannel())
        self.right_motor = PWMSim(robot.right_motor.getChannel())
        # Wheels 2 ft apart; 12 ft/s at full power.
        self.drivetrain = TwoMotorDrivetrain(x_wheelbase=2, speed=12)

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        speeds = self.drivetrain.calculate(self.left_motor.getSpeed(), self.right_motor.getSpeed())
        self.physics_controller.drive(speeds, tm_diff)
