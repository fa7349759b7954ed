"""The lights: alliance colour while disabled, green with a piece, a rainbow in autonomous."""

import commands2
import wpilib
from constants import LED_COUNT, Pwm

from subsystems.gripper import Gripper


class Leds(commands2.Subsystem):
    """Sixty lights."""

    def __init__(self, gripper: Gripper) -> None:
        super().__init__()
        self.gripper = gripper
        self.strip = wpilib.AddressableLED(Pwm.LEDS)
        self.strip.setLength(LED_COUNT)
        self.buffer = [wpilib.AddressableLED.LEDData() for _ in range(LED_COUNT)]
        self.rainbow = wpilib.LEDPattern.rainbow(255, 128).scrollAtRelativeSpeed(0.25)
        self.piece = wpilib.LEDPattern.solid(wpilib.Color.kGreen).blink(0.2)
        self.off = wpilib.LEDPattern.off()
        self.alliance = {
            wpilib.DriverStation.Alliance.kRed: wpilib.LEDPattern.solid(wpilib.Color.kRed).breathe(2.0),
            wpilib.DriverStation.Alliance.kBlue: wpilib.LEDPattern.solid(wpilib.Color.kBlue).breathe(2.0),
        }
        self.strip.setData(self.buffer)
        self.strip.start()

    def periodic(self) -> None:
        """Show the robot's state."""
        alliance = wpilib.DriverStation.getAlliance()
        if wpilib.DriverStation.isAutonomousEnabled():
            pattern = self.rainbow
        elif self.gripper.has_piece():
            pattern = self.piece
        elif wpilib.DriverStation.isDisabled() and alliance is not None:
            pattern = self.alliance[alliance]
        else:
            pattern = self.off
        pattern.applyTo(self.buffer)
        self.strip.setData(self.buffer)
