"""The smallest robot that drives: two motors and a gamepad. The rest is yours to write."""

import wpilib
import wpilib.drive


class MyRobot(wpilib.TimedRobot):
    """Your robot. Each method is called by WPILib when its name says so."""

    def robotInit(self) -> None:
        """Called once when the program starts: create motors, sensors and gamepads here."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.right_motor.setInverted(True)  # the two face each other
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

    def autonomousInit(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: leave the starting line, in one second."""
        speed = 0.4 if self.timer.get() < 1.0 else 0.0
        self.drive.arcadeDrive(speed, 0.0, squareInputs=False)

    def teleopPeriodic(self) -> None:
        """Called every 20 ms in teleop. Up and left are negative on sticks, but positive for the robot."""
        self.drive.arcadeDrive(-self.gamepad.getLeftY(), -self.gamepad.getRightX())

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing jumps later."""
        self.drive.stopMotor()
