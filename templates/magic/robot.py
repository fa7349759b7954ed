"""A MagicRobot: components that do one thing each, and a state machine that plays them together."""

import magicbot
import wpilib

from components.drivetrain import Drivetrain
from components.shooter import Shooter
from components.shootercontrol import ShooterControl


class MyRobot(magicbot.MagicRobot):
    """Your robot: makes the devices; magicbot makes the components and hands them the devices by name."""

    # Components run every 20 ms, in this order: those that decide stand before those that act.
    shooter_control: ShooterControl
    shooter: Shooter
    drivetrain: Drivetrain

    def createObjects(self) -> None:
        """Called once when the program starts: `drivetrain_left_motor` is the drivetrain's `left_motor`."""
        self.drivetrain_left_motor = wpilib.PWMSparkMax(0)
        self.drivetrain_right_motor = wpilib.PWMSparkMax(1)
        self.drivetrain_right_motor.setInverted(True)  # the two face each other

        self.shooter_wheel_motor = wpilib.PWMSparkMax(2)
        self.shooter_feeder_motor = wpilib.PWMVictorSPX(3)
        self.shooter_wheel_encoder = wpilib.Encoder(0, 1)
        self.shooter_wheel_encoder.setDistancePerPulse(1 / 1024)  # 1024 counts are a turn

        self.gamepad = wpilib.XboxController(0)

    def teleopPeriodic(self) -> None:
        """Called every 20 ms in teleop, before the components: tell them what the driver wants."""
        # Forward and left are negative on a stick.
        self.drivetrain.go(-self.gamepad.getLeftY(), -self.gamepad.getRightX())
        if self.gamepad.getAButton():
            self.shooter_control.fire()
