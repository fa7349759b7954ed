"""An arm with a PID controller; the motor controller itself limits the power to its range."""

import wpilib
from wpimath.controller import PIDController

PRESETS = (0.0, 30.0, 60.0, 90.0)  # degrees
COUNTS_PER_DEGREE = 4096 / 360


class MyRobot(wpilib.TimedRobot):
    """Presets by the bumpers; the stick moves the goal."""

    def robotInit(self) -> None:
        self.motor = wpilib.PWMSparkMax(0)
        self.encoder = wpilib.Encoder(0, 1)
        self.encoder.setDistancePerPulse(1 / COUNTS_PER_DEGREE)
        self.controller = PIDController(0.03, 0.0, 0.001)
        self.gamepad = wpilib.XboxController(0)
        self.preset = 0
        self.goal = PRESETS[0]

    def robotPeriodic(self) -> None:
        wpilib.SmartDashboard.putNumber("Arm", self.encoder.getDistance())
        wpilib.SmartDashboard.putNumber("Goal", self.goal)

    def hold_here(self) -> None:
        """Start from where the arm is."""
        self.controller.reset()
        self.goal = max(PRESETS[0], min(PRESETS[-1], self.encoder.getDistance()))

    def move(self) -> None:
        """Move towards the goal: the motor controller clamps what is more than full power."""
        self.motor.set(self.controller.calculate(self.encoder.getDistance(), self.goal))

    def autonomousInit(self) -> None:
        self.hold_here()
        self.goal = PRESETS[2]

    def autonomousPeriodic(self) -> None:
        self.move()

    def teleopInit(self) -> None:
        self.gamepad.getRightBumperPressed()  # forget what was pressed while disabled
        self.gamepad.getLeftBumperPressed()
        self.hold_here()

    def teleopPeriodic(self) -> None:
        if self.gamepad.getRightBumperPressed():
            self.preset = min(len(PRESETS) - 1, self.preset + 1)
            self.goal = PRESETS[self.preset]
        if self.gamepad.getLeftBumperPressed():
            self.preset = max(0, self.preset - 1)
            self.goal = PRESETS[self.preset]
        stick = -self.gamepad.getLeftY()
        if abs(stick) > 0.1:
            self.goal = max(PRESETS[0], min(PRESETS[-1], self.goal + stick))
        self.move()

    def testInit(self) -> None:
        self.motor.set(0.0)

    def disabledInit(self) -> None:
        self.motor.set(0.0)
