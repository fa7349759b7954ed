"""A competition robot on CTRE devices: swerve drive, elevator, arm, intake and shooter."""

from commands2 import Command, CommandScheduler, TimedCommandRobot
from phoenix6 import SignalLogger
from wpilib import Alert, DataLogManager, DriverStation, PowerDistribution, RobotController, SmartDashboard, Timer

from constants import Can
from robotcontainer import RobotContainer


class MyRobot(TimedCommandRobot):
    """Logs, watches the battery, and starts the autonomous command. The container has the rest."""

    def __init__(self) -> None:
        """Create everything."""
        super().__init__()
        DataLogManager.start()
        DriverStation.startDataLog(DataLogManager.getLog())
        # The hoot file of a whole match is large: on the robot only.
        SignalLogger.enable_auto_logging(not self.isSimulation())
        DriverStation.silenceJoystickConnectionWarning(True)
        self.container = RobotContainer()
        self.power = PowerDistribution(Can.POWER_HUB, PowerDistribution.ModuleType.kRev)
        self.autonomous: Command | None = None
        self.battery_alert = Alert("The battery is low: change it before the match", Alert.AlertType.kWarning)
        self.joystick_alert = Alert("The driver's controller is not connected", Alert.AlertType.kInfo)
        self.enabled_timer = Timer()
        SmartDashboard.putData("Scheduler", CommandScheduler.getInstance())

    def robotPeriodic(self) -> None:
        """Run the scheduler, and report on the robot."""
        super().robotPeriodic()
        volts = RobotController.getBatteryVoltage()
        self.battery_alert.set(self.isDisabled() and volts < 12.0)
        self.joystick_alert.set(not DriverStation.isJoystickConnected(0))
        SmartDashboard.putNumber("Robot/Voltage", volts)
        SmartDashboard.putNumber("Robot/Current", self.power.getTotalCurrent())
        SmartDashboard.putNumber("Robot/MatchTime", DriverStation.getMatchTime())

    def autonomousInit(self) -> None:
        """Start what was chosen."""
        self.enabled_timer.restart()
        self.autonomous = self.container.autonomous_command()
        if self.autonomous is not None:
            self.autonomous.schedule()

    def teleopInit(self) -> None:
        """The driver takes over."""
        self.enabled_timer.restart()
        if self.autonomous is not None:
            self.autonomous.cancel()

    def testInit(self) -> None:
        """Begin without commands."""
        CommandScheduler.getInstance().cancelAll()

    def disabledInit(self) -> None:
        """Write what was logged to the disk."""
        SmartDashboard.putNumber("Robot/EnabledSeconds", self.enabled_timer.get())
        DataLogManager.getLog().flush()
