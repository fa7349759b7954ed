"""Physics of the robot in tests and in the simulator: its mass, its wheels and its encoders.

The numbers describe a typical robot. Replace them with your robot's.
"""

from pyfrc.physics import motor_cfgs, tankmodel
from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.encoders import EncoderShaft
from pyfrc.physics.units import units
from wpilib.simulation import PWMMotorControllerSim

from robot import MyRobot

METRES_PER_FOOT = 0.3048
MASS = 110 * units.lbs  # with battery and bumpers
TRACK_WIDTH = 24 * units.inch  # from the left wheels to the right wheels


class PhysicsEngine:
    """Move the robot according to its motors. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        # The two motors of a side are geared together, so one of them is enough.
        self.left_motor = PWMMotorControllerSim(robot.left_motor)
        self.right_motor = PWMMotorControllerSim(robot.right_motor)
        self.left_encoder = EncoderShaft(robot.left_encoder, METRES_PER_FOOT)
        self.right_encoder = EncoderShaft(robot.right_encoder, METRES_PER_FOOT)

        self.drivetrain = tankmodel.TankModel.theory(
            motor_cfgs.MOTOR_CFG_CIM,
            robot_mass=MASS,
            gearing=10.71,  # turns of a motor per turn of a wheel
            nmotors=4,  # all of them, to accelerate as the robot does
            x_wheelbase=TRACK_WIDTH,
            robot_width=27 * units.inch,  # with bumpers
            robot_length=33 * units.inch,
            wheel_diameter=15 * units.cm,
        )
        # With this moment of inertia the wheels never slip: the robot turns as far as its encoders measure.
        self.drivetrain.inertia = MASS * TRACK_WIDTH**2 / 2

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        moved = self.drivetrain.calculate(self.left_motor.get_throttle(), self.right_motor.get_throttle(), tm_diff)
        self.physics_controller.move_robot(moved)
        self.left_encoder.turn_to(self.drivetrain.l_position, self.drivetrain.l_velocity)
        self.right_encoder.turn_to(self.drivetrain.r_position, self.drivetrain.r_velocity)
