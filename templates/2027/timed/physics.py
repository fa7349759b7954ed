"""Physics of the robot in tests and in the simulator: a drivetrain without inertia."""

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.drivetrains import TwoMotorDrivetrain
from wpilib.simulation import PWMMotorControllerSim

from robot import MyRobot


class PhysicsEngine:
    """Move the robot according to its motors. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.left_motor = PWMMotorControllerSim(robot.left_motor)
        self.right_motor = PWMMotorControllerSim(robot.right_motor)
        # Wheels 2 ft apart; 12 ft/s at full power.
        self.drivetrain = TwoMotorDrivetrain(x_wheelbase=2, speed=12)

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        speeds = self.drivetrain.calculate(self.left_motor.get_throttle(), self.right_motor.get_throttle())
        self.physics_controller.drive(speeds, tm_diff)
