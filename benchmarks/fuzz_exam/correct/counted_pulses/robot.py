"""Count balls and a wheel's turns, and turn to a pose that a camera's computer may fail to measure, or measure late."""

import math

import ntcore
import wpilib
from wpimath.geometry import Pose2d

FEEDER_SPEEDS = (1.0, 0.8, 0.5, 0.0)
LATEST_SECONDS = 0.5


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.gamepad = wpilib.XboxController(0)
        self.balls = wpilib.Counter(0)
        self.wheel = wpilib.Counter(1)
        self.wheel.setDistancePerPulse(0.25)
        self.feeder = wpilib.PWMSparkMax(0)
        self.shooter = wpilib.PWMSparkMax(1)
        self.turret = wpilib.PWMSparkMax(2)
        table = ntcore.NetworkTableInstance.getDefault().getTable("vision")
        self.pose = table.getStructTopic("pose", Pose2d).subscribe(Pose2d())
        self.latency = table.getDoubleTopic("latency").subscribe(0.0)

    def turn(self) -> float:
        """Return how fast the turret turns: not with a pose that is old or no number."""
        degrees = self.pose.get().rotation().degrees()
        if self.latency.get() / 1000 > LATEST_SECONDS or not math.isfinite(degrees):
            return 0.0
        return max(-0.5, min(0.5, degrees / 90))

    def teleopPeriodic(self) -> None:
        if self.gamepad.getAButtonPressed():
            self.balls.reset()
        self.feeder.set(FEEDER_SPEEDS[min(self.balls.get(), len(FEEDER_SPEEDS) - 1)])
        self.shooter.set(0.9 if self.wheel.getRate() < 5.0 else 0.4)
        self.turret.set(self.turn())
        wpilib.SmartDashboard.putNumber(
            "Seconds for a turn", 0.0 if self.wheel.getStopped() else self.wheel.getPeriod()
        )

    def disabledInit(self) -> None:
        for motor in (self.feeder, self.shooter, self.turret):
            motor.set(0.0)

    def teleopExit(self) -> None:
        self.disabledInit()
