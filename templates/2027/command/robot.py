"""A command-based robot: its parts are in subsystems/ and commands/, the buttons in robotcontainer.py."""

import commands2

from robotcontainer import RobotContainer


class MyRobot(commands2.TimedCommandRobot):
    """The robot. The scheduler runs the commands every 20 ms, so this class is short."""

    def __init__(self) -> None:
        """Called once when the program starts."""
        super().__init__()
        self.container = RobotContainer()
        self.autonomous_command: commands2.Command | None = None

    def autonomous_init(self) -> None:
        """Called once when autonomous starts: start the command chosen on the dashboard."""
        self.autonomous_command = self.container.get_autonomous_command()
        if self.autonomous_command is not None:
            self.autonomous_command.schedule()

    def teleop_init(self) -> None:
        """Called once when teleop starts: cancel the autonomous command, so that the driver takes over."""
        if self.autonomous_command is not None:
            self.autonomous_command.cancel()

    # The scheduler does what is to be done every 20 ms, in commands and in `periodic` of the subsystems.

    def robot_periodic(self) -> None:
        """Called every 20 ms in every mode."""

    def autonomous_periodic(self) -> None:
        """Called every 20 ms in autonomous."""

    def teleop_periodic(self) -> None:
        """Called every 20 ms in teleop."""

    def disabled_periodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""
