"""Checks for the pit."""

import wpilib

from robot import MyRobot


@wpilib.utility(name="Check the motors", description="Lift the wheels off the floor: each motor runs for one second")
class CheckMotors(wpilib.PeriodicOpMode):
    """Run one motor after the other."""

    def __init__(self, robot: MyRobot) -> None:
        """Called when the opmode is selected, while the robot is disabled."""
        super().__init__()
        self.motors = [robot.left_motor, robot.right_motor]
        self.timer = wpilib.Timer()

    def start(self) -> None:
        """Called once when the robot is enabled."""
        self.timer.restart()

    def periodic(self) -> None:
        """Called every 20 ms while the robot is enabled."""
        for second, motor in enumerate(self.motors):
            runs = second <= self.timer.get() < second + 1
            motor.set_throttle(0.2 if runs else 0.0)

    def end(self) -> None:
        """Called once when the robot is disabled."""
        for motor in self.motors:
            motor.stop_motor()
