"""The smallest robot that drives: two motors and a gamepad. Write the rest yourself."""

import wpilib
import wpilib_drivers


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def __init__(self) -> None:
        """Called once when the program starts: create motors, sensors and gamepads here."""
        super().__init__()
        self.left_motor = wpilib_drivers.PWMSparkMax(0)
        self.right_motor = wpilib_drivers.PWMSparkMax(1)
        self.right_motor.set_inverted(True)  # the motors face each other
        self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

    def autonomous_init(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()

    def autonomous_periodic(self) -> None:
        """Called every 20 ms in autonomous: leave the starting line within one second."""
        speed = 0.4 if self.timer.get() < 1.0 else 0.0
        self.drive.arcade_drive(speed, 0.0, square_inputs=False)

    def teleop_periodic(self) -> None:
        """Called every 20 ms in teleop. Up and left are negative on sticks, but positive for the robot."""
        self.drive.arcade_drive(-self.gamepad.get_left_y(), -self.gamepad.get_right_x())

    def disabled_init(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drive.stop_motor()

    def disabled_periodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""

    def robot_periodic(self) -> None:
        """Called every 20 ms in every mode, after the others."""
