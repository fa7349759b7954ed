"""The gripper: a cylinder that closes it, rollers that pull a piece in, and a sensor that sees the piece."""

import commands2
import commands2.button
import wpilib
from constants import Can, Dio, Pwm


class Gripper(commands2.Subsystem):
    """Holds a piece."""

    def __init__(self) -> None:
        super().__init__()
        self.hub = wpilib.PneumaticHub(Can.PNEUMATIC_HUB)
        self.hub.enableCompressorAnalog(70, 115)
        self.cylinder = self.hub.makeDoubleSolenoid(0, 1)
        self.rollers = wpilib.PWMVictorSPX(Pwm.ROLLERS)
        self.piece_sensor = wpilib.DigitalInput(Dio.PIECE_SENSOR)
        self.debouncer = commands2.button.Trigger(lambda: not self.piece_sensor.get()).debounce(0.1)
        self.low_pressure = wpilib.Alert("The tank's pressure is low.", wpilib.Alert.AlertType.kWarning)

    def periodic(self) -> None:
        """Update the dashboard."""
        pressure = self.hub.getPressure(0)
        # WPILib's simulation has no voltage of the hub's sensor.
        self.low_pressure.set(pressure < 50 and wpilib.RobotBase.isReal())
        wpilib.SmartDashboard.putNumber("Gripper/pressure", pressure)
        wpilib.SmartDashboard.putBoolean("Gripper/piece", self.has_piece())

    def has_piece(self) -> bool:
        """Return whether the sensor has seen a piece for a tenth of a second."""
        return self.debouncer.getAsBoolean()

    def close(self) -> None:
        """Close the gripper and stop the rollers."""
        self.cylinder.set(wpilib.DoubleSolenoid.Value.kForward)
        self.rollers.stopMotor()

    def open(self) -> None:
        """Open the gripper."""
        self.cylinder.set(wpilib.DoubleSolenoid.Value.kReverse)

    def intake(self) -> commands2.Command:
        """Make a command that pulls a piece in until the sensor sees it."""
        return self.startRun(self.open, lambda: self.rollers.set(0.7)).until(self.has_piece).finallyDo(self._end)

    def release(self) -> commands2.Command:
        """Make a command that pushes the piece out."""
        return self.startRun(self.open, lambda: self.rollers.set(-0.5)).withTimeout(0.5).finallyDo(self._end)

    def _end(self, interrupted: bool) -> None:
        self.close()
