"""A MagicRobot that goes in any direction, and crawls while a button is held."""

import magicbot
import wpilib
from components.base import Base
from wpimath.geometry import Translation2d

DEADBAND = 0.08


def without_deadband(value: float) -> float:
    """Nothing near the middle, where no stick is quiet."""
    return value if abs(value) > DEADBAND else 0.0


class MyRobot(magicbot.MagicRobot):
    """Creates the devices; magicbot hands them to the components by name."""

    base: Base

    def createObjects(self) -> None:
        """Create what the components ask for as 'component_thing'."""
        self.base_left = wpilib.PWMSparkMax(0)
        self.base_right = wpilib.PWMSparkMax(1)
        self.base_right.setInverted(True)
        self.base_across = wpilib.PWMSparkMax(2)
        self.base_fan = wpilib.DigitalOutput(0)
        self.base_gyro = wpilib.AnalogGyro(0)
        self.claw = wpilib.DoubleSolenoid(wpilib.PneumaticsModuleType.CTREPCM, 0, 1)
        self.gamepad = wpilib.XboxController(0)

    def teleopInit(self) -> None:
        """Start with an open claw, looking along the field."""
        self.claw.set(wpilib.DoubleSolenoid.Value.kForward)
        self.base_gyro.reset()

    def teleopPeriodic(self) -> None:
        """The left stick goes, the right one turns; the left bumper crawls, B grips or lets go."""
        gamepad = self.gamepad
        # Pushing a stick forward, or to the left, reads as a negative number.
        stick = Translation2d(-without_deadband(gamepad.getLeftY()), -without_deadband(gamepad.getLeftX()))
        if gamepad.getLeftBumper():
            self.base.crawl(stick)
        else:
            self.base.go(stick, -without_deadband(gamepad.getRightX()))
        if gamepad.getBButtonPressed():
            self.claw.toggle()
