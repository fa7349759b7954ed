"""What the robot does by itself at the start of a match: one class for each way."""

import wpilib

from robot import MyRobot

LEAVES = 1.5  # metres, for `LeaveLine`


@wpilib.autonomous(name="Leave the line", description="Drive 1.5 m and stop")
class LeaveLine(wpilib.PeriodicOpMode):
    """Drive forward until the encoders have measured the distance."""

    def __init__(self, robot: MyRobot) -> None:
        """Called when the opmode is selected, while the robot is disabled."""
        super().__init__()
        self.robot = robot
        self.begins_at = 0.0

    def start(self) -> None:
        """Called once when the robot is enabled."""
        self.begins_at = self.robot.distance()

    def periodic(self) -> None:
        """Called every 20 ms while the robot is enabled. The robot keeps its heading."""
        driven = self.robot.distance() - self.begins_at
        power = 0.4 if driven < LEAVES else 0.0
        self.robot.drive.arcade_drive(power, 0.0, square_inputs=False)

    def end(self) -> None:
        """Called once when the robot is disabled."""
        self.robot.drive.stop_motor()


@wpilib.autonomous(name="Stay", description="Stand still, for matches in which our partners need the space")
class Stay(wpilib.PeriodicOpMode):
    """The smallest opmode. A drive must be told in each turn what to do, also to stand still."""

    def __init__(self, robot: MyRobot) -> None:
        """Called when the opmode is selected, while the robot is disabled."""
        super().__init__()
        self.robot = robot

    def periodic(self) -> None:
        """Called every 20 ms while the robot is enabled."""
        self.robot.drive.stop_motor()
