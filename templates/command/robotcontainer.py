"""The robot's subsystems, and what each button does."""

import commands2
import commands2.button
import wpilib

from commands.drivedistance import DriveDistance
from subsystems.drive import Drive
from subsystems.intake import Intake


class RobotContainer:
    """The subsystems, the gamepad and the autonomous chooser."""

    def __init__(self) -> None:
        self.drive = Drive()
        self.intake = Intake()
        self.gamepad = commands2.button.CommandXboxController(0)

        self.configure_buttons()

        self.chooser = wpilib.SendableChooser()
        self.chooser.setDefaultOption("Drive 2 m", DriveDistance(self.drive, 2.0))
        self.chooser.addOption("Fetch", self.fetch())
        self.chooser.addOption("Nothing", commands2.cmd.none())
        wpilib.SmartDashboard.putData("Autonomous", self.chooser)

    def configure_buttons(self) -> None:
        """Bind the buttons to commands."""
        # The default command: the sticks drive if nothing else does. Forward and left are negative on a stick.
        self.drive.setDefaultCommand(
            self.drive.arcade(lambda: -self.gamepad.getLeftY(), lambda: -self.gamepad.getRightX())
        )
        self.gamepad.a().whileTrue(self.intake.take_in())
        self.gamepad.b().whileTrue(self.intake.spit_out())
        self.gamepad.x().onTrue(DriveDistance(self.drive, -0.5))  # drive back a little

    def fetch(self) -> commands2.Command:
        """Drive to a game piece with the intake running, and bring it back."""
        return commands2.cmd.sequence(
            commands2.cmd.deadline(DriveDistance(self.drive, 1.5), self.intake.take_in()),
            DriveDistance(self.drive, -1.5),
        )

    def get_autonomous_command(self) -> commands2.Command | None:
        """Return the command chosen on the dashboard."""
        chosen: commands2.Command | None = self.chooser.getSelected()
        return chosen
