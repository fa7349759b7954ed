"""What the driver does."""

import wpilib

from robot import MyRobot


@wpilib.teleop(description="The left stick drives, the right stick turns")
class Drive(wpilib.PeriodicOpMode):
    """Drive with the sticks. WPILib makes a new `Drive` each time that it is selected."""

    def __init__(self, robot: MyRobot) -> None:
        """Called when the opmode is selected, while the robot is disabled."""
        super().__init__()
        self.robot = robot

    def periodic(self) -> None:
        """Called every 20 ms while the robot is enabled. Up and left are negative on sticks, but positive for it."""
        gamepad = self.robot.gamepad
        slowly = 0.5 if gamepad.get_right_bumper_button() else 1.0
        self.robot.drive.arcade_drive(-slowly * gamepad.get_left_y(), -slowly * gamepad.get_right_x())

    def end(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.robot.drive.stop_motor()
