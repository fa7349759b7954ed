"""An arcade-drive robot that scores its autonomous by the game message."""

import wpilib
import wpilib.drive


class ModeCounter:
    """Counts how often a mode was entered, and how many loops it ran."""

    def __init__(self) -> None:
        """Nothing has happened yet."""
        self.entered = 0
        self.loops = 0


class MyRobot(wpilib.TimedRobot):
    """One joystick, two motors, and a three-second autonomous."""

    def robotInit(self) -> None:
        """Create the devices once; they live as long as the program."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        # The motors face each other, so forward for one is backward for the other.
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)

        self.stick = wpilib.Joystick(0)
        self.timer = wpilib.Timer()
        self.turn = 0.0

        self.disabled = ModeCounter()
        self.autonomous = ModeCounter()
        self.teleop = ModeCounter()

    def disabledInit(self) -> None:
        """Stop: a robot that is enabled again must not jump."""
        self.disabled.entered += 1
        self.drive.stopMotor()

    def disabledPeriodic(self) -> None:
        """Count the loops spent waiting."""
        self.disabled.loops += 1

    def autonomousInit(self) -> None:
        """Start the clock, and ask the field which side is ours."""
        self.autonomous.entered += 1
        self.timer.restart()
        message = wpilib.DriverStation.getGameSpecificMessage()
        self.turn = {"L": 0.5, "R": -0.5}.get(message[:1], 0.0)

    def autonomousPeriodic(self) -> None:
        """Drive forward for two seconds, turn for one, then stand still."""
        self.autonomous.loops += 1
        if self.timer.get() < 2.0:
            self.drive.arcadeDrive(0.5, 0.0, squareInputs=False)
        elif self.timer.get() < 3.0:
            self.drive.arcadeDrive(0.0, self.turn, squareInputs=False)
        else:
            self.drive.stopMotor()

    def teleopInit(self) -> None:
        """Count the start of teleop."""
        self.teleop.entered += 1

    def teleopPeriodic(self) -> None:
        """Let the driver drive; pushing a stick forward reads as a negative number."""
        self.teleop.loops += 1
        self.drive.arcadeDrive(-self.stick.getY(), -self.stick.getX())
