"""A robot whose devices are class variables: created when this file is imported."""

import wpilib


class MyRobot(wpilib.TimedRobot):
    """Often seen, never advised: prefer creating devices in robotInit."""

    # Everything up to the first method runs before there is a robot.
    motor = wpilib.PWMSparkMax(0)
    encoder = wpilib.Encoder(0, 1)
    stick = wpilib.Joystick(0)
    encoder.setDistancePerPulse(0.5)
    starts = 0

    def robotInit(self) -> None:
        """Count in the class, too: a second robot in the same process would show."""
        MyRobot.starts += 1

    def autonomousPeriodic(self) -> None:
        """Drive until the encoder has counted ten metres."""
        self.motor.set(0.5 if self.encoder.getDistance() < 10.0 else 0.0)

    def teleopPeriodic(self) -> None:
        """Let the driver drive."""
        self.motor.set(-self.stick.getY())

    def disabledPeriodic(self) -> None:
        """Stand still."""
        self.motor.set(0.0)
