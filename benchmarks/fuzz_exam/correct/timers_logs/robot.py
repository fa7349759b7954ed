"""Logs events of the match, and times the driver's actions."""

import logging

import wpilib
import wpilib.drive
import wpiutil.log

logger = logging.getLogger("robot")


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        wpilib.DataLogManager.start()
        log = wpilib.DataLogManager.getLog()
        self.events = wpiutil.log.StringLogEntry(log, "/events")
        self.speed = wpiutil.log.DoubleLogEntry(log, "/speed")
        self.left = wpilib.PWMSparkMax(0)
        self.right = wpilib.PWMSparkMax(1)
        self.right.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
        self.encoder = wpilib.Encoder(0, 1)
        self.encoder.setDistancePerPulse(0.001)
        self.gamepad = wpilib.XboxController(0)
        self.mode_timer = wpilib.Timer()
        self.boost_timer = wpilib.Timer()
        self.boosts = 0

    def note(self, what: str) -> None:
        """Write an event with the match's name, as far as it is known."""
        alliance = wpilib.DriverStation.getAlliance()
        name = "unknown" if alliance is None else alliance.name
        event = wpilib.DriverStation.getEventName() or "practice"
        self.events.append(f"{event}/{wpilib.DriverStation.getMatchNumber()}/{name}: {what}")
        logger.info("%s (%s)", what, name)

    def robotPeriodic(self) -> None:
        self.speed.append(self.encoder.getRate())

    def autonomousInit(self) -> None:
        self.note("autonomous " + (wpilib.DriverStation.getGameSpecificMessage()[:1].upper() or "without a message"))
        self.mode_timer.restart()

    def autonomousPeriodic(self) -> None:
        self.drive.arcadeDrive(0.4 if self.mode_timer.get() < 1.5 else 0.0, 0.0, squareInputs=False)

    def teleopInit(self) -> None:
        self.note("teleop")
        self.mode_timer.restart()
        self.boost_timer.stop()
        self.boost_timer.reset()

    def teleopPeriodic(self) -> None:
        if self.gamepad.getYButtonPressed() and not self.boost_timer.isRunning():
            self.boosts += 1
            self.boost_timer.restart()
            self.note(f"boost {self.boosts}")
        if self.boost_timer.hasElapsed(1.5):
            self.boost_timer.stop()
            self.boost_timer.reset()
        power = 1.0 if self.boost_timer.isRunning() else 0.7
        self.drive.arcadeDrive(-self.gamepad.getLeftY() * power, -self.gamepad.getRightX() * power)

    def testPeriodic(self) -> None:
        self.drive.stopMotor()

    def disabledInit(self) -> None:
        self.drive.stopMotor()
        self.note(f"disabled after {self.mode_timer.get():.1f} s")
