"""The subsystems, what each button does, and the autonomous modes."""

import commands2
import wpilib
from commands2.button import CommandXboxController, Trigger
from pathplannerlib.auto import AutoBuilder, NamedCommands
from pathplannerlib.util import FlippingUtil
from wpilib import Color, LEDPattern
from wpilib.interfaces import GenericHID
from wpimath.geometry import Translation2d

from commands.aimatpoint import AimAtPoint
from commands.teleopdrive import TeleopDrive
from constants import Controllers, Field
from subsystems.climber import Climber
from subsystems.drivetrain import Drivetrain, is_red
from subsystems.elevator import Elevator
from subsystems.intake import Intake
from subsystems.leds import Leds
from subsystems.shooter import Shooter
from subsystems.vision import Vision


def hub() -> Translation2d:
    """Return where the own alliance's hub is."""
    return FlippingUtil.flipFieldPosition(Field.HUB) if is_red() else Field.HUB


class RobotContainer:
    """Everything that the robot consists of."""

    def __init__(self) -> None:
        self.drivetrain = Drivetrain()
        self.elevator = Elevator()
        self.shooter = Shooter()
        self.intake = Intake()
        self.climber = Climber()
        self.vision = Vision(self.drivetrain)
        self.leds = Leds()
        self.driver = CommandXboxController(Controllers.DRIVER)
        self.operator = CommandXboxController(Controllers.OPERATOR)

        self.register_named_commands()
        self.configure_driver()
        self.configure_operator()
        self.configure_leds()

        self.chooser = AutoBuilder.buildAutoChooser("ShootAndCollect")
        self.chooser.addOption("SysId forward", self.drivetrain.sysid.quasistatic(self.forward_direction()))
        wpilib.SmartDashboard.putData("Auto", self.chooser)
        wpilib.SmartDashboard.putData("Scheduler", commands2.CommandScheduler.getInstance())

    @staticmethod
    def forward_direction() -> object:
        """Return SysId's name for forwards."""
        return commands2.sysid.SysIdRoutine.Direction.kForward

    def register_named_commands(self) -> None:
        """Give PathPlanner's autos their commands."""
        NamedCommands.registerCommand("shoot", self.score())
        NamedCommands.registerCommand("collect", self.collect())
        NamedCommands.registerCommand("raise", self.elevator.move_to("ElevatorHub"))
        NamedCommands.registerCommand("stow", self.elevator.stow())

    def score(self) -> commands2.Command:
        """Return a command that shoots from the height for the hub, and goes down again."""
        return commands2.cmd.sequence(
            commands2.cmd.parallel(
                self.elevator.move_to("ElevatorHub").withTimeout(2.0),
                self.shooter.spin_up().until(self.shooter.at_speed).withTimeout(2.0),
            ),
            self.shooter.shoot(),
            self.elevator.stow().withTimeout(2.0),
        ).withName("Score")

    def collect(self) -> commands2.Command:
        """Return a command that collects until a piece is in the feeder."""
        return commands2.cmd.race(self.intake.collect(), self.shooter.load()).withName("CollectPiece")

    def configure_driver(self) -> None:
        """Bind the driver's sticks and buttons."""
        driver = self.driver

        def forward() -> float:
            return -driver.getLeftY()

        def left() -> float:
            return -driver.getLeftX()

        self.drivetrain.setDefaultCommand(TeleopDrive(self.drivetrain, forward, left, lambda: -driver.getRightX()))
        driver.leftBumper().whileTrue(self.drivetrain.drive_slowly())
        driver.rightTrigger(0.5).whileTrue(AimAtPoint(self.drivetrain, forward, left, hub))
        driver.x().whileTrue(self.drivetrain.lock_wheels())
        driver.start().onTrue(self.drivetrain.zero_heading())
        driver.leftTrigger(0.5).whileTrue(self.collect())
        driver.b().whileTrue(self.intake.spit_out())

    def configure_operator(self) -> None:
        """Bind the operator's sticks and buttons."""
        operator = self.operator
        self.shooter.setDefaultCommand(self.shooter.idle())
        operator.a().onTrue(self.elevator.stow())
        operator.b().onTrue(self.elevator.move_to("ElevatorHub"))
        operator.y().onTrue(self.elevator.move_to("ElevatorTop"))
        operator.povUp().whileTrue(self.elevator.run(lambda: self.elevator.nudge(0.01)))
        operator.povDown().whileTrue(self.elevator.run(lambda: self.elevator.nudge(-0.01)))
        operator.leftTrigger(0.5).whileTrue(self.shooter.spin_up())
        operator.rightBumper().onTrue(self.score())
        operator.back().onTrue(self.climber.arm())
        operator.povLeft().whileTrue(self.climber.extend())
        operator.povRight().whileTrue(self.climber.retract())

        Trigger(self.shooter.has_piece).onTrue(self.rumble(0.3))
        Trigger(lambda: 0 < wpilib.DriverStation.getMatchTime() < 20).and_(wpilib.DriverStation.isTeleopEnabled).onTrue(
            self.rumble(1.0)
        )

    def rumble(self, seconds: float) -> commands2.Command:
        """Return a command that both drivers feel."""

        def set_rumble(strength: float) -> None:
            for controller in (self.driver, self.operator):
                controller.getHID().setRumble(GenericHID.RumbleType.kBothRumble, strength)

        return commands2.cmd.startEnd(lambda: set_rumble(1.0), lambda: set_rumble(0.0)).withTimeout(seconds)

    def configure_leds(self) -> None:
        """Say what the LED strip shows when."""
        self.leds.show_while(lambda: self.climber.armed, self.leds.rainbow)
        self.leds.show_while(self.shooter.at_speed, LEDPattern.solid(Color.kGreen))
        self.leds.show_while(lambda: self.shooter.goal > 1500, LEDPattern.solid(Color.kYellow).blink(0.1))
        self.leds.show_while(self.shooter.has_piece, LEDPattern.solid(Color.kPurple))

    def autonomous_command(self) -> commands2.Command | None:
        """Return the command chosen on the dashboard."""
        return self.chooser.getSelected()
