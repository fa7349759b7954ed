"""The competition robot: swerve drive, intake, elevator, shooter, climber."""

import commands2
import wpilib

from constants import CanIds
from robotcontainer import RobotContainer


class MyRobot(commands2.TimedCommandRobot):
    """Starts the logs, and schedules the autonomous command."""

    def robotInit(self) -> None:
        """Create everything."""
        import urcl  # it starts a thread: here, pyfrc imports the robot only once

        wpilib.DataLogManager.start()
        wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())
        urcl.URCL.start(CanIds.NAMES)
        wpilib.DriverStation.silenceJoystickConnectionWarning(True)

        self.power = wpilib.PowerDistribution(CanIds.POWER_HUB, wpilib.PowerDistribution.ModuleType.kRev)
        self.container = RobotContainer()
        self.autonomous_command: commands2.Command | None = None
        self.battery_alert = wpilib.Alert("The battery is low", wpilib.Alert.AlertType.kWarning)
        self.addPeriodic(self.check_battery, 0.5)

    def check_battery(self) -> None:
        """Warn of an empty battery."""
        voltage = wpilib.RobotController.getBatteryVoltage()
        self.battery_alert.set(self.isDisabled() and voltage < 12.0)
        wpilib.SmartDashboard.putNumber("Battery/Voltage", voltage)
        wpilib.SmartDashboard.putNumber("Battery/Current", self.power.getTotalCurrent())

    def robotPeriodic(self) -> None:
        """Called in every mode."""
        wpilib.SmartDashboard.putNumber("MatchTime", wpilib.DriverStation.getMatchTime())

    def autonomousInit(self) -> None:
        """Begin what was chosen on the dashboard."""
        self.autonomous_command = self.container.autonomous_command()
        if self.autonomous_command is not None:
            commands2.CommandScheduler.getInstance().schedule(self.autonomous_command)

    def teleopInit(self) -> None:
        """The drivers take over."""
        if self.autonomous_command is not None:
            self.autonomous_command.cancel()

    def testInit(self) -> None:
        """Stop everything."""
        commands2.CommandScheduler.getInstance().cancelAll()
