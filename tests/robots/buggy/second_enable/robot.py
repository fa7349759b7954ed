"""A robot that scores with one button: lift, let go, come down, each for its time."""

import wpilib
import wpilib.drive

SCORE_BUTTON, CANCEL_BUTTON = 1, 2

# When each part of scoring is over, in seconds from its beginning.
LIFTED, LET_GO, BACK = 0.8, 1.2, 2.0

LIFT_SPEED, LOWER_SPEED = 0.7, -0.4


class Scorer:
    """A lift with a claw, and what they do one after the other."""

    def __init__(self) -> None:
        """Nothing is going on."""
        self.lift = wpilib.PWMSparkMax(2)
        self.claw = wpilib.Solenoid(wpilib.PneumaticsModuleType.CTREPCM, 0)
        self.scoring = False
        self.started: float | None = None
        self.scored = 0

    def start(self) -> None:
        """Begin to score, unless that is going on."""
        if self.scoring:
            return
        self.scoring = True
        self.started = wpilib.Timer.getFPGATimestamp()

    def cancel(self) -> None:
        """Give it up: the claw stays as it is."""
        self.scoring = False
        self.started = None
        self.lift.set(0.0)

    def stop(self) -> None:
        """The robot was disabled: stop where it is."""
        self.started = None
        self.lift.set(0.0)

    def update(self) -> None:
        """Called once each loop while the robot is enabled."""
        if not self.scoring:
            return
        elapsed = wpilib.Timer.getFPGATimestamp() - self.started  # the bug: stop() has forgotten when, but not that
        if elapsed < LIFTED:
            self.claw.set(False)
            self.lift.set(LIFT_SPEED)
        elif elapsed < LET_GO:
            self.claw.set(True)
            self.lift.set(0.0)
        elif elapsed < BACK:
            self.lift.set(LOWER_SPEED)
        else:
            self.scored += 1
            self.cancel()


class MyRobot(wpilib.TimedRobot):
    """Scores once in autonomous, then whenever the driver asks for it."""

    def robotInit(self) -> None:
        """Create the devices; the motors face each other."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.scorer = Scorer()
        self.gamepad = wpilib.Joystick(0)

    def disabledInit(self) -> None:
        """Nothing moves."""
        self.drive.stopMotor()
        self.scorer.stop()

    def autonomousInit(self) -> None:
        """It was loaded with one piece."""
        self.scorer.start()

    def autonomousPeriodic(self) -> None:
        """Score, then drive off."""
        self.scorer.update()
        self.drive.arcadeDrive(0.0 if self.scorer.scoring else 0.3, 0.0)

    def teleopPeriodic(self) -> None:
        """A scores, B gives it up."""
        self.drive.arcadeDrive(-self.gamepad.getY(), -self.gamepad.getX())
        if self.gamepad.getRawButtonPressed(SCORE_BUTTON):
            self.scorer.start()
        if self.gamepad.getRawButtonPressed(CANCEL_BUTTON):
            self.scorer.cancel()
        self.scorer.update()
        wpilib.SmartDashboard.putNumber("Scored", self.scorer.scored)
