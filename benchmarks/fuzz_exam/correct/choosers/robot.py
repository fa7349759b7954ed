"""Choosers without a default, numbers and texts on the dashboard: none of them is trusted."""

import math

import wpilib
import wpilib.drive


def number(key: str, default: float, low: float, high: float) -> float:
    """Return a number from the dashboard within its limits."""
    value = wpilib.SmartDashboard.getNumber(key, default)
    return max(low, min(high, value)) if math.isfinite(value) else default


def seconds(key: str) -> float:
    """Return the seconds in a text field; 0 if there is no number in it."""
    try:
        value = float(wpilib.SmartDashboard.getString(key, "0").replace(",", "."))
    except ValueError:
        return 0.0
    return max(0.0, min(10.0, value)) if math.isfinite(value) else 0.0


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.left = wpilib.PWMSparkMax(0)
        self.right = wpilib.PWMSparkMax(1)
        self.right.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()
        self.routine = wpilib.SendableChooser()
        self.routine.addOption("Straight", (0.4, 0.0))
        self.routine.addOption("Curve", (0.4, 0.2))
        self.routine.addOption("Stay", None)
        self.driver = wpilib.SendableChooser()
        self.driver.setDefaultOption("Careful", 0.6)
        self.driver.addOption("Fast", 1.0)
        wpilib.SmartDashboard.putData("Routine", self.routine)
        wpilib.SmartDashboard.putData("Driver", self.driver)
        wpilib.SmartDashboard.putNumber("Turn factor", 0.7)
        wpilib.SmartDashboard.putString("Delay", "0")
        self.chosen: tuple[float, float] | None = None
        self.delay = 0.0

    def autonomousInit(self) -> None:
        self.timer.restart()
        self.chosen = self.routine.getSelected()
        self.delay = seconds("Delay")

    def autonomousPeriodic(self) -> None:
        now = self.timer.get() - self.delay
        if self.chosen is not None and 0 <= now < 2.0:
            self.drive.arcadeDrive(*self.chosen, squareInputs=False)
        else:
            self.drive.stopMotor()

    def teleopPeriodic(self) -> None:
        scale = self.driver.getSelected() or 0.6
        turn = number("Turn factor", 0.7, 0.1, 1.0)
        self.drive.arcadeDrive(-self.gamepad.getLeftY() * scale, -self.gamepad.getRightX() * scale * turn)

    def testPeriodic(self) -> None:
        self.drive.stopMotor()

    def disabledInit(self) -> None:
        self.drive.stopMotor()
