"""A tank drive with an elevator, an arm and a gripper."""

import commands2
import wpilib
from constants import Can
from robotcontainer import RobotContainer


class MyRobot(commands2.TimedCommandRobot):
    """The robot: logging, alerts and modes. Everything else is in the container and the subsystems."""

    def robotInit(self) -> None:
        """Start the logs, and create everything."""
        wpilib.DataLogManager.start()
        wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())
        wpilib.DriverStation.silenceJoystickConnectionWarning(True)
        wpilib.LiveWindow.disableAllTelemetry()
        self.power = wpilib.PowerDistribution(Can.PDH, wpilib.PowerDistribution.ModuleType.kRev)
        wpilib.SmartDashboard.putData("Power", self.power)
        self.low_battery = wpilib.Alert("The battery is low: change it.", wpilib.Alert.AlertType.kWarning)
        self.battery_limit = wpilib.Preferences.getDouble("Battery/warn below", 11.8)
        wpilib.Preferences.initDouble("Battery/warn below", 11.8)
        self.no_autonomous = wpilib.Alert("No autonomous routine is chosen.", wpilib.Alert.AlertType.kInfo)
        self.container = RobotContainer()
        self.autonomous_command: commands2.Command | None = None
        self.addPeriodic(self.check_battery, 1.0, 0.005)

    def check_battery(self) -> None:
        """Warn when the battery is low, once a second."""
        voltage = wpilib.RobotController.getBatteryVoltage()
        self.low_battery.set(wpilib.DriverStation.isDisabled() and voltage < self.battery_limit)
        wpilib.SmartDashboard.putNumber("Power/volts", voltage)
        wpilib.SmartDashboard.putNumber("Power/total amperes", self.power.getTotalCurrent())

    def robotPeriodic(self) -> None:
        """Tell the drivers how much time is left."""
        wpilib.SmartDashboard.putNumber("Match time", wpilib.DriverStation.getMatchTime())

    def disabledInit(self) -> None:
        """Take over what was tuned between matches."""
        self.container.elevator.reload_gains()
        self.container.rumble(0)

    def disabledPeriodic(self) -> None:
        """Show whether a routine is chosen."""
        command = self.container.autonomous_command()
        self.no_autonomous.set(command is None or command.getName() == "Nothing")

    def autonomousInit(self) -> None:
        """Start the routine that was chosen."""
        self.autonomous_command = self.container.autonomous_command()
        if self.autonomous_command is not None:
            self.autonomous_command.schedule()

    def teleopInit(self) -> None:
        """End the routine."""
        if self.autonomous_command is not None:
            self.autonomous_command.cancel()

    def testInit(self) -> None:
        """End all commands."""
        commands2.CommandScheduler.getInstance().cancelAll()
