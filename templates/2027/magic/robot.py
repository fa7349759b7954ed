"""A MagicRobot: components that do one thing each, and a state machine that coordinates them."""

import magicbot
import wpilib
import wpilib_drivers

from components.drivetrain import Drivetrain
from components.shooter import Shooter
from components.shootercontrol import ShooterControl


class MyRobot(magicbot.MagicRobot):
    """The robot: creates the devices. magicbot creates the components and sets their devices by name."""

    # Components run every 20 ms, in this order: those that decide come before those that act.
    shooter_control: ShooterControl
    shooter: Shooter
    drivetrain: Drivetrain

    def create_objects(self) -> None:
        """Called once when the program starts. `drivetrain_left_motor` becomes the drivetrain's `left_motor`."""
        self.drivetrain_left_motor = wpilib_drivers.PWMSparkMax(0)
        self.drivetrain_right_motor = wpilib_drivers.PWMSparkMax(1)
        self.drivetrain_right_motor.set_inverted(True)  # the motors face each other

        self.shooter_wheel_motor = wpilib_drivers.PWMSparkMax(2)
        self.shooter_feeder_motor = wpilib_drivers.PWMVictorSPX(3)
        self.shooter_wheel_encoder = wpilib.Encoder(0, 1)
        self.shooter_wheel_encoder.set_distance_per_pulse(1 / 1024)  # 1024 counts are a turn

        self.gamepad = wpilib.XboxController(0)

    def teleop_periodic(self) -> None:
        """Called every 20 ms in teleop, before the components: pass the driver's input to them."""
        # Forward and left are negative on a stick.
        self.drivetrain.go(-self.gamepad.get_left_y(), -self.gamepad.get_right_x())
        if self.gamepad.get_a_button():
            self.shooter_control.fire()

    def disabled_periodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""
