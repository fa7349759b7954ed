"""The robot's subsystems, and what each button does."""

import commands2
import commands2.button
import tunables

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

        self.chooser = tunables.Selectable[commands2.Command]()
        self.chooser.add_default("Drive 2 m", DriveDistance(self.drive, 2.0))
        self.chooser.add("Fetch", self.fetch())
        self.chooser.add("Nothing", commands2.cmd.none())
        tunables.publish("Autonomous", self.chooser)

    def configure_buttons(self) -> None:
        """Bind the buttons to commands."""
        # The default command: the sticks drive if nothing else does. Forward and left are negative on a stick.
        self.drive.set_default_command(
            self.drive.arcade(lambda: -self.gamepad.get_left_y(), lambda: -self.gamepad.get_right_x())
        )
        self.gamepad.a().while_true(self.intake.take_in())
        self.gamepad.b().while_true(self.intake.spit_out())
        self.gamepad.x().on_true(DriveDistance(self.drive, -0.5))  # drive back a little

    def fetch(self) -> commands2.Command:
        """Drive to a game piece with the intake running, and bring it back."""
        return commands2.cmd.sequence(
            commands2.cmd.deadline(DriveDistance(self.drive, 1.5), self.intake.take_in()),
            DriveDistance(self.drive, -1.5),
        )

    def get_autonomous_command(self) -> commands2.Command | None:
        """Return the command chosen on the dashboard."""
        chosen: commands2.Command | None = self.chooser.get_selected()
        return chosen
