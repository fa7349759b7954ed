"""All subsystems, and what the buttons do to them."""

import math

from commands2 import Command, cmd
from commands2.button import CommandXboxController, Trigger
from commands2.sysid import SysIdRoutine
from wpilib import DriverStation, SmartDashboard, XboxController
from wpimath import applyDeadband
from wpimath.filter import SlewRateLimiter
from wpimath.geometry import Pose2d, Rotation2d

from commands import autos
from commands.superstructure import Superstructure
from constants import Elevator as ElevatorNumbers
from subsystems.arm import Arm
from subsystems.drivetrain import Drivetrain
from subsystems.elevator import Elevator
from subsystems.intake import Intake
from subsystems.leds import Leds
from subsystems.shooter import Shooter


def shaped(value: float) -> float:
    """Leave out the middle of a stick, and give small movements more resolution."""
    value = applyDeadband(value, 0.08)
    return math.copysign(value * value, value)


class RobotContainer:
    """The driver has port 0, the operator port 1."""

    def __init__(self) -> None:
        self.drivetrain = Drivetrain()
        self.elevator = Elevator()
        self.arm = Arm()
        self.intake = Intake()
        self.shooter = Shooter()
        self.leds = Leds(lambda: self.intake.loaded, self.shooter.ready)
        self.superstructure = Superstructure(self.elevator, self.arm, self.intake, self.shooter)

        self.driver = CommandXboxController(0)
        self.operator = CommandXboxController(1)
        self.forward_limiter = SlewRateLimiter(4.0)
        self.left_limiter = SlewRateLimiter(4.0)
        self.auto_chooser = autos.chooser(self.drivetrain, self.superstructure)
        SmartDashboard.putData("Auto", self.auto_chooser)
        self._bind_driver()
        self._bind_operator()

    def forward(self) -> float:
        """Return the driver's wish along the field, from -1 to 1."""
        return self.forward_limiter.calculate(-shaped(self.driver.getLeftY()))

    def left(self) -> float:
        """Return the driver's wish across the field, from -1 to 1."""
        return self.left_limiter.calculate(-shaped(self.driver.getLeftX()))

    def turn(self) -> float:
        """Return the driver's wish to turn, counter-clockwise, from -1 to 1."""
        return -shaped(self.driver.getRightX())

    def _bind_driver(self) -> None:
        drive = self.drivetrain
        drive.setDefaultCommand(drive.drive_with(self.forward, self.left, self.turn))
        self.driver.rightBumper().whileTrue(drive.drive_with(self.forward, self.left, self.turn, slow=0.3))
        self.driver.x().whileTrue(drive.cross())
        self.driver.a().whileTrue(drive.face(Rotation2d(), self.forward, self.left))
        self.driver.b().whileTrue(drive.face(Rotation2d.fromDegrees(90), self.forward, self.left))
        self.driver.start().onTrue(
            cmd.runOnce(lambda: drive.reset_pose(Pose2d(drive.pose().translation(), Rotation2d()))).ignoringDisable(
                True
            )
        )
        in_test = Trigger(DriverStation.isTestEnabled)
        (in_test & self.driver.y()).whileTrue(drive.sysid.quasistatic(SysIdRoutine.Direction.kForward))
        (in_test & self.driver.back()).whileTrue(drive.sysid.dynamic(SysIdRoutine.Direction.kForward))

    def _face_ahead(self) -> None:
        pose = self.drivetrain.pose()
        self.drivetrain.reset_pose(Pose2d(pose.translation(), Rotation2d()))

    def _bind_operator(self) -> None:
        superstructure = self.superstructure
        self.operator.a().onTrue(superstructure.stow())
        self.operator.b().whileTrue(superstructure.fetch()).onFalse(superstructure.stow())
        self.operator.x().onTrue(superstructure.raise_to_score(ElevatorNumbers.SCORE_LOW))
        self.operator.y().onTrue(superstructure.raise_to_score(ElevatorNumbers.SCORE_HIGH))
        self.operator.rightTrigger().whileTrue(superstructure.shoot())
        self.operator.leftTrigger().whileTrue(self.intake.roll(-0.6))
        rumble = self.operator.getHID()
        Trigger(lambda: self.intake.loaded).onTrue(
            cmd.startEnd(
                lambda: rumble.setRumble(XboxController.RumbleType.kBothRumble, 0.8),
                lambda: rumble.setRumble(XboxController.RumbleType.kBothRumble, 0),
            ).withTimeout(0.5)
        )

    def autonomous_command(self) -> Command | None:
        """Return what was chosen on the dashboard."""
        return self.auto_chooser.getSelected()
