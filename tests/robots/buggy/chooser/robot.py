"""A command-based robot that each driver drives in the way they like: they choose it on the dashboard."""

from collections.abc import Callable

import commands2
import commands2.button
import wpilib
import wpilib.drive

LEFT, RIGHT = 0, 1

ARCADE, TANK, CURVATURE = "Arcade", "Tank", "Curvature"


class Drive(commands2.Subsystem):
    """Two motors."""

    def __init__(self) -> None:
        """Create the devices; the motors face each other."""
        super().__init__()
        self.left_motor = wpilib.PWMSparkMax(LEFT)
        self.right_motor = wpilib.PWMSparkMax(RIGHT)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)

    def stop(self) -> None:
        """Stand still."""
        self.drive.stopMotor()


class MyRobot(commands2.TimedCommandRobot):
    """Drives as chosen; the start button takes over another choice."""

    def robotInit(self) -> None:
        """Create the subsystem, the choice, and what each choice means."""
        self.base = Drive()
        self.driver = commands2.button.CommandXboxController(0)

        self.style = wpilib.SendableChooser()
        self.style.setDefaultOption(ARCADE, ARCADE)
        self.style.addOption(TANK, TANK)
        self.style.addOption(CURVATURE, CURVATURE)
        wpilib.SmartDashboard.putData("Drive style", self.style)

        self.styles: dict[str, Callable[[], None]] = {
            ARCADE: self.arcade,
            TANK: self.tank,
        }
        self.driver.start().onTrue(commands2.InstantCommand(self.apply_choice))

    def apply_choice(self) -> None:
        """From now on, drive as the dashboard says."""
        drive = self.styles[self.style.getSelected()]  # the bug: a style can be chosen that nobody has registered
        # A default command runs whenever no other needs the drive.
        self.base.setDefaultCommand(commands2.RunCommand(drive, self.base))
        running = self.base.getCurrentCommand()
        if running is not None:
            running.cancel()

    def arcade(self) -> None:
        """One stick: forward, and a turn."""
        self.base.drive.arcadeDrive(-self.driver.getLeftY(), -self.driver.getLeftX())

    def tank(self) -> None:
        """A stick for each side."""
        self.base.drive.tankDrive(-self.driver.getLeftY(), -self.driver.getRightY())

    def curvature(self) -> None:
        """Like a car; while the left bumper is held, it turns on the spot."""
        turns_in_place = self.driver.getHID().getLeftBumper()
        self.base.drive.curvatureDrive(-self.driver.getLeftY(), -self.driver.getRightX(), turns_in_place)

    def autonomousInit(self) -> None:
        """Leave the starting line."""
        self.base.removeDefaultCommand()
        leave = commands2.RunCommand(lambda: self.base.drive.arcadeDrive(0.4, 0.0), self.base)
        leave.withTimeout(2.0).finallyDo(lambda interrupted: self.base.stop()).schedule()

    def teleopInit(self) -> None:
        """Drive as chosen before the match."""
        self.apply_choice()

    def disabledInit(self) -> None:
        """Nothing moves."""
        self.base.stop()
