"""A robot with a loop of its own: everything that TimedRobot would do, done by hand."""

import hal
import wpilib


class MyRobot(wpilib.RobotBase):
    """Asks for the mode, does its work, waits for 20 ms, and does it again."""

    PERIOD = 0.02

    def __init__(self) -> None:
        """Create the devices."""
        super().__init__()
        self.running = True
        self.motor = wpilib.PWMSparkMax(0)
        self.stick = wpilib.Joystick(0)
        self.loops = {"disabled": 0, "autonomous": 0, "teleop": 0, "test": 0}
        self.autonomous_started = 0.0

    def startCompetition(self) -> None:
        """The whole program; it returns after endCompetition was called."""
        # Without this line the driver station shows "No Robot Code".
        hal.observeUserProgramStarting()
        mode = ""
        while self.running:
            # Joysticks and modes stay as they were until they are refreshed.
            wpilib.DriverStation.refreshData()
            previous, mode = mode, self.mode()
            self.loops[mode] += 1
            if mode == "autonomous":
                if previous != "autonomous":
                    self.autonomous_started = wpilib.Timer.getFPGATimestamp()
                self.autonomous()
            elif mode == "teleop":
                self.teleop()
            elif mode == "test":
                hal.observeUserProgramTest()
            else:
                self.disabled()
            wpilib.wait(self.PERIOD)

    def endCompetition(self) -> None:
        """Ask the loop to come to its end."""
        self.running = False

    def mode(self) -> str:
        """Name the mode that the driver station asks for."""
        if self.isDisabled():
            return "disabled"
        if self.isAutonomous():
            return "autonomous"
        return "test" if self.isTest() else "teleop"

    def disabled(self) -> None:
        """Stand still."""
        hal.observeUserProgramDisabled()
        self.motor.set(0.0)

    def autonomous(self) -> None:
        """Drive forward for three seconds."""
        hal.observeUserProgramAutonomous()
        elapsed = wpilib.Timer.getFPGATimestamp() - self.autonomous_started
        # Half a loop of room: 150 loops of 20 ms, however the numbers are rounded.
        self.motor.set(0.5 if elapsed < 3.0 - self.PERIOD / 2 else 0.0)

    def teleop(self) -> None:
        """Let the driver drive."""
        hal.observeUserProgramTeleop()
        self.motor.set(-self.stick.getY())
