"""A robot that shoots: a wheel that takes a second to come up to speed, and a kicker that pushes the ball into it."""

import wpilib

WHEEL_MOTOR, KICKER_MOTOR, DRIVE_MOTOR = range(3)
ENCODER_CHANNELS = (0, 1)
COUNTS_PER_TURN = 2048

SPIN_AXIS = 3  # the right trigger, from 0 to 1
KICK_BUTTON = 1

TARGET_RATE = 60.0  # turns per second
WHEEL_POWER = 0.8
KICKER_POWER = 0.5
# How far the wheel turns while it throws a ball, and how long the kicker may push at most, in seconds.
TURNS_PER_BALL = 12.0
LONGEST_KICK = 1.0


class Shooter:
    """The wheel, its encoder, and the kicker."""

    def __init__(self) -> None:
        """The encoder measures turns."""
        self.wheel = wpilib.PWMSparkMax(WHEEL_MOTOR)
        self.kicker = wpilib.PWMSparkMax(KICKER_MOTOR)
        self.encoder = wpilib.Encoder(*ENCODER_CHANNELS)
        self.encoder.setDistancePerPulse(1 / COUNTS_PER_TURN)
        self.kick_timer = wpilib.Timer()
        self.kick_seconds = 0.0
        self.spinning = False

    def spin(self, on: bool) -> None:
        """Turn the wheel, or let it run out."""
        self.spinning = on
        self.wheel.set(WHEEL_POWER if on else 0.0)

    def kick(self) -> None:
        """Push a ball into the wheel, for as long as the wheel needs to throw it; a slow wheel needs longer."""
        if not self.spinning or self.kicking():
            return
        seconds = TURNS_PER_BALL / abs(self.encoder.getRate())  # the bug: the wheel is on, but need not turn yet
        self.kick_seconds = min(seconds, LONGEST_KICK)
        self.kick_timer.restart()

    def kicking(self) -> bool:
        """Say whether a ball is on its way."""
        return self.kick_timer.isRunning() and self.kick_timer.get() < self.kick_seconds

    def update(self) -> None:
        """Called once each loop, last."""
        self.kicker.set(KICKER_POWER if self.kicking() else 0.0)

    def stop(self) -> None:
        """Everything off."""
        self.kick_timer.stop()
        self.spin(False)
        self.kicker.set(0.0)


class MyRobot(wpilib.TimedRobot):
    """The right trigger spins the wheel, A throws a ball."""

    def robotInit(self) -> None:
        """Create the devices."""
        self.shooter = Shooter()
        self.drive_motor = wpilib.PWMSparkMax(DRIVE_MOTOR)
        self.gamepad = wpilib.Joystick(0)
        self.timer = wpilib.Timer()

    def disabledInit(self) -> None:
        """Nothing moves, except for a wheel that runs out."""
        self.shooter.stop()
        self.drive_motor.set(0.0)

    def autonomousInit(self) -> None:
        """Start the clock."""
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Spin up, throw what it was loaded with, drive away."""
        self.shooter.spin(self.timer.get() < 4.0)
        if 3.0 < self.timer.get() < 4.0 and self.shooter.encoder.getRate() > TARGET_RATE / 2:
            self.shooter.kick()
        self.shooter.update()
        self.drive_motor.set(0.4 if 4.0 < self.timer.get() < 6.0 else 0.0)

    def teleopPeriodic(self) -> None:
        """The trigger, the button, the stick."""
        self.shooter.spin(self.gamepad.getRawAxis(SPIN_AXIS) > 0.5)
        if self.gamepad.getRawButton(KICK_BUTTON):
            self.shooter.kick()
        self.shooter.update()
        self.drive_motor.set(-self.gamepad.getY())
