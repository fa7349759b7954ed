"""What a pit crew wants to know before the match."""

import rev
import wpilib
from magicbot import feedback, tunable

from .swerve_module import SwerveModule

ERROR, WARNING = wpilib.Alert.AlertType.kError, wpilib.Alert.AlertType.kWarning


class Diagnostics:
    """Alerts for what is unplugged, hot or empty."""

    swerve_modules: list[SwerveModule]
    sparks: dict[str, rev.SparkMax]
    pdh: wpilib.PowerDistribution
    pneumatics: wpilib.PneumaticHub

    low_battery = tunable(11.8)
    too_hot = tunable(70.0)

    def setup(self) -> None:
        """Create an alert for each device."""
        self.battery = wpilib.Alert("The battery is low", WARNING)
        self.no_pressure = wpilib.Alert("The compressor fills the tank", wpilib.Alert.AlertType.kInfo)
        self.gamepads = [
            wpilib.Alert(f"{name} gamepad (port {port}) is unplugged", WARNING)
            for port, name in enumerate(("The driver's", "The operator's"))
        ]
        self.encoders = {
            module: wpilib.Alert(f"The {module.name} encoder is unplugged", ERROR) for module in self.swerve_modules
        }
        self.faults = {name: wpilib.Alert(f"SPARK MAX of {name} has a fault", ERROR) for name in self.sparks}
        self.heat = {name: wpilib.Alert(f"Motor of {name} is hot", WARNING) for name in self.sparks}
        self.loops = 0

    @feedback
    def get_battery(self) -> float:
        return wpilib.RobotController.getBatteryVoltage()

    @feedback
    def get_current(self) -> float:
        return self.pdh.getTotalCurrent()

    @feedback
    def get_healthy(self) -> bool:
        return not any(alert.get() for alert in (*self.faults.values(), *self.encoders.values()))

    def check(self) -> None:
        """Look at a part of the devices: each in every fourth of a second, also while disabled."""
        self.loops += 1
        if self.loops % 12:
            return
        self.battery.set(wpilib.RobotController.getBatteryVoltage() < self.low_battery)
        self.no_pressure.set(not self.pneumatics.getPressureSwitch())
        for port, alert in enumerate(self.gamepads):
            alert.set(not wpilib.DriverStation.isJoystickConnected(port))
        for module, alert in self.encoders.items():
            alert.set(not module.absolute_encoder.isConnected())
        for name, spark in self.sparks.items():
            self.faults[name].set(spark.hasActiveFault())
            self.heat[name].set(spark.getMotorTemperature() > self.too_hot)

    def execute(self) -> None:
        """Nothing more is to do while enabled."""
