"""A command-based robot. What it can do is in subsystems/ and commands/, which button does it in robotcontainer.py."""

import commands2

from robotcontainer import RobotContainer


class MyRobot(commands2.TimedCommandRobot):
    """Your robot. There is little to do here: every 20 ms the scheduler runs the commands."""

    def robotInit(self) -> None:
        """Called once when the program starts."""
        self.container = RobotContainer()
        self.autonomous_command: commands2.Command | None = None

    def autonomousInit(self) -> None:
        """Called once when autonomous starts: start the command that was chosen on the dashboard."""
        self.autonomous_command = self.container.get_autonomous_command()
        if self.autonomous_command is not None:
            self.autonomous_command.schedule()

    def teleopInit(self) -> None:
        """Called once when teleop starts: the driver takes over, whatever autonomous was about to do."""
        if self.autonomous_command is not None:
            self.autonomous_command.cancel()
