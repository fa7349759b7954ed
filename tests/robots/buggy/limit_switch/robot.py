"""A robot with an intake: a state machine takes pieces in, holds them, and shakes itself free when one is stuck."""

import enum

import wpilib
import wpilib.drive

INTAKE_MOTOR = 2
PIECE_SWITCH = 0

TAKE_BUTTON, REVERSE_BUTTON = 5, 6

TAKE_SPEED, REVERSE_SPEED, SHAKE_SPEED = 0.8, -0.6, 0.4

# A piece is out after so many seconds of reversing; if the switch is still pressed, it is stuck.
REVERSE_SECONDS = 0.2
# It is shaken for at least so long, each way for a tenth of a second.
FREE_SECONDS = 2.0
SHAKE_SECONDS = 0.1


class State(enum.Enum):
    """What the intake is doing."""

    EMPTY = "empty"
    TAKING = "taking"
    HOLDING = "holding"
    REVERSING = "reversing"
    STUCK = "stuck"


class Intake:
    """Rollers, and a switch that a piece presses when it is all the way in."""

    def __init__(self) -> None:
        """The switch pulls its input to ground when something presses it."""
        self.motor = wpilib.PWMSparkMax(INTAKE_MOTOR)
        self.switch = wpilib.DigitalInput(PIECE_SWITCH)
        self.state = State.EMPTY
        self.since = 0.0

    def go(self, state: State) -> None:
        """Change the state."""
        self.state = state
        self.since = wpilib.Timer.getFPGATimestamp()

    def ask(self, *, take: bool, reverse: bool) -> None:
        """What the driver wants; a stuck piece comes first."""
        if self.state == State.STUCK:
            return
        if reverse:
            if self.state != State.REVERSING:
                self.go(State.REVERSING)
        elif take:
            if self.state != State.HOLDING:
                self.go(State.TAKING)
        elif self.state in (State.TAKING, State.REVERSING):
            self.go(State.EMPTY)

    def stop(self) -> None:
        """The robot is disabled: what moves is to stop, a piece that it holds stays."""
        if self.state in (State.TAKING, State.REVERSING):  # the bug: a stuck piece is shaken all the same
            self.go(State.EMPTY)

    def update(self) -> None:
        """Called once each loop."""
        pressed = not self.switch.get()
        elapsed = wpilib.Timer.getFPGATimestamp() - self.since
        if self.state == State.TAKING and pressed:
            self.go(State.HOLDING)
        elif self.state == State.REVERSING and pressed and elapsed > REVERSE_SECONDS:
            self.go(State.STUCK)
        elif self.state == State.STUCK and not pressed and elapsed > FREE_SECONDS:
            self.go(State.EMPTY)
        shaking = SHAKE_SPEED if int(elapsed / SHAKE_SECONDS) % 2 else -SHAKE_SPEED
        speeds = {State.TAKING: TAKE_SPEED, State.REVERSING: REVERSE_SPEED, State.STUCK: shaking}
        self.motor.set(speeds.get(self.state, 0.0))


class MyRobot(wpilib.TimedRobot):
    """Takes with the left bumper, reverses with the right one."""

    def robotInit(self) -> None:
        """Create the devices; the drive's motors face each other."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.intake = Intake()
        self.gamepad = wpilib.Joystick(0)
        self.timer = wpilib.Timer()

    def robotPeriodic(self) -> None:
        """The intake goes on in every mode, so that a piece taken in autonomous is held in teleop."""
        self.intake.update()
        wpilib.SmartDashboard.putString("Intake", self.intake.state.value)

    def disabledInit(self) -> None:
        """Nothing moves."""
        self.drive.stopMotor()
        self.intake.stop()

    def autonomousInit(self) -> None:
        """Start the clock."""
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Fetch a piece: drive at it with the rollers on. What is in the robot then is spat out."""
        fetching = self.timer.get() < 3.0
        self.intake.ask(take=fetching, reverse=not fetching)
        self.drive.arcadeDrive(0.4 if fetching else 0.0, 0.0)

    def teleopPeriodic(self) -> None:
        """The stick drives, the bumpers take and reverse."""
        gamepad = self.gamepad
        self.drive.arcadeDrive(-gamepad.getY(), -gamepad.getX())
        self.intake.ask(take=gamepad.getRawButton(TAKE_BUTTON), reverse=gamepad.getRawButton(REVERSE_BUTTON))
