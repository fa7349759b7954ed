"""All motors are set at one place, robotPeriodic, and are off unless the robot is enabled."""

import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.left = wpilib.PWMSparkMax(0)
        self.right = wpilib.PWMSparkMax(1)
        self.right.setInverted(True)
        self.fan = wpilib.Spark(2)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()
        self.forward = self.turn = 0.0
        self.fan_on = False

    def autonomousInit(self) -> None:
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        self.forward, self.turn = (0.3, 0.0) if self.timer.get() < 2.0 else (0.0, 0.0)

    def teleopInit(self) -> None:
        self.fan_on = False

    def teleopPeriodic(self) -> None:
        self.forward = -self.gamepad.getLeftY()
        self.turn = self.gamepad.getRightX()
        if self.gamepad.getAButtonPressed():
            self.fan_on = not self.fan_on

    def testPeriodic(self) -> None:
        self.forward = self.turn = 0.0
        self.fan_on = False

    def disabledInit(self) -> None:
        self.forward = self.turn = 0.0
        self.fan_on = False

    def robotPeriodic(self) -> None:
        """Called after the mode's own function: the only place that sets motors."""
        if self.isEnabled():
            scale = max(1.0, abs(self.forward) + abs(self.turn))
            self.left.set((self.forward + self.turn) / scale)
            self.right.set((self.forward - self.turn) / scale)
            self.fan.set(0.5 if self.fan_on else 0.0)
        else:
            for motor in (self.left, self.right, self.fan):
                motor.set(0.0)
