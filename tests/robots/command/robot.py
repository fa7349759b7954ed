"""A command-based robot: one arm, three buttons, and an autonomous made of commands."""

import commands2
import commands2.button
import wpilib


class Arm(commands2.Subsystem):
    """An arm that goes up and down with one motor, up to a limit switch."""

    def __init__(self) -> None:
        """Create the devices, and count what happens to them."""
        super().__init__()
        self.motor = wpilib.PWMSparkMax(0)
        # A limit switch pulls its input to ground: True means that it is not pressed.
        self.top_switch = wpilib.DigitalInput(0)
        self.periodic_calls = 0
        self.raised = 0

    def periodic(self) -> None:
        """Called by the scheduler once each loop."""
        self.periodic_calls += 1

    def at_top(self) -> bool:
        """Say whether the arm presses its limit switch."""
        return not self.top_switch.get()

    def stop(self) -> None:
        """Hold the arm where it is."""
        self.motor.set(0.0)

    def move(self, speed: float) -> commands2.Command:
        """Make a command that moves the arm for as long as it runs."""
        return self.runEnd(lambda: self.motor.set(speed), self.stop)

    def raise_to_top(self) -> commands2.Command:
        """Make a command that ends by itself when the arm is up."""
        return self.move(1.0).until(self.at_top).finallyDo(self.count_raise)

    def count_raise(self, interrupted: bool) -> None:
        """Count the raises that reached the top."""
        if not interrupted:
            self.raised += 1


class MyRobot(commands2.TimedCommandRobot):
    """Binds buttons to commands; the scheduler does the rest."""

    def robotInit(self) -> None:
        """Create the subsystem, and say what each button means."""
        self.arm = Arm()
        self.log: list[str] = []
        self.autonomous_command: commands2.Command | None = None

        self.operator = commands2.button.CommandXboxController(0)
        self.operator.a().whileTrue(self.arm.move(0.5))
        self.operator.b().whileTrue(self.arm.move(-0.5))
        self.operator.x().onTrue(self.arm.raise_to_top())

    def note(self, what: str) -> commands2.Command:
        """Make a command that writes down that it ran."""
        return commands2.InstantCommand(lambda: self.log.append(what))

    def autonomousInit(self) -> None:
        """Raise the arm for a second, wait for another, lower it for half a second."""
        # The times end between two loops, so that rounding cannot make a step one loop longer.
        self.autonomous_command = commands2.SequentialCommandGroup(
            self.note("up"),
            self.arm.move(0.5).withTimeout(0.99),
            self.note("wait"),
            commands2.WaitCommand(0.99),
            self.note("down"),
            self.arm.move(-0.5).withTimeout(0.49),
            self.note("done"),
        )
        self.autonomous_command.schedule()

    def teleopInit(self) -> None:
        """The driver takes over, whatever autonomous was about to do."""
        if self.autonomous_command is not None:
            self.autonomous_command.cancel()
