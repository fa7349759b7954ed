"""Aim with a camera that may be missing, see nothing, or send nonsense."""

import math

import ntcore
import wpilib
import wpilib.drive
from wpimath.filter import MedianFilter


class Camera:
    """Reads [tx, ty, area] from NetworkTables."""

    def __init__(self) -> None:
        table = ntcore.NetworkTableInstance.getDefault().getTable("camera")
        self.target = table.getDoubleArrayTopic("target").subscribe([])
        self.filter = MedianFilter(5)
        self.last_seen: float | None = None

    def offset(self) -> float | None:
        """Return the target's direction in degrees to the right; None without a believable target."""
        values = self.target.get()
        if len(values) < 3 or not all(math.isfinite(value) for value in values):
            return None
        tx, _, area = values[:3]
        if area <= 0.1 or abs(tx) > 40:
            return None
        self.last_seen = wpilib.Timer.getFPGATimestamp()
        return self.filter.calculate(tx)

    def fresh(self) -> bool:
        """Return whether it has seen the target within half a second."""
        return self.last_seen is not None and wpilib.Timer.getFPGATimestamp() - self.last_seen < 0.5


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.left = wpilib.PWMSparkMax(0)
        self.right = wpilib.PWMSparkMax(1)
        self.right.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
        self.rangefinder = wpilib.AnalogInput(0)
        self.camera = Camera()
        self.gamepad = wpilib.XboxController(0)

    def metres(self) -> float:
        """Return the range: the sensor's voltage falls with it. Unplugged, it reads 0 V."""
        volts = self.rangefinder.getVoltage()
        return min(3.0, 0.6 / volts) if volts > 0.2 else 3.0

    def robotPeriodic(self) -> None:
        wpilib.SmartDashboard.putBoolean("Sees target", self.camera.fresh())
        wpilib.SmartDashboard.putNumber("Range", self.metres())

    def steer(self) -> float:
        """Return how hard to turn to the target, 0 without one."""
        offset = self.camera.offset()
        return 0.0 if offset is None else max(-0.4, min(0.4, -0.02 * offset))

    def autonomousPeriodic(self) -> None:
        self.drive.arcadeDrive(0.3 if self.metres() > 1.0 else 0.0, self.steer(), squareInputs=False)

    def teleopPeriodic(self) -> None:
        turn = self.steer() if self.gamepad.getAButton() else -self.gamepad.getRightX()
        self.drive.arcadeDrive(-self.gamepad.getLeftY(), turn)

    def testPeriodic(self) -> None:
        self.drive.stopMotor()

    def disabledInit(self) -> None:
        self.drive.stopMotor()
