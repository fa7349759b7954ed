"""The LED strip shows the drivers what the robot does."""

from collections.abc import Callable

import commands2
import wpilib
from wpilib import AddressableLED, Color, LEDPattern

from constants import Leds as Settings
from constants import Ports


class Leds(commands2.Subsystem):
    """Shows one pattern at a time. The first condition that holds selects it."""

    def __init__(self) -> None:
        super().__init__()
        self.strip = AddressableLED(Ports.LED_STRIP)
        self.strip.setLength(Settings.LENGTH)
        self.buffer = [AddressableLED.LEDData() for _ in range(Settings.LENGTH)]
        self.strip.setData(self.buffer)
        self.strip.start()

        self.rainbow = LEDPattern.rainbow(255, 128).scrollAtAbsoluteSpeed(0.5, Settings.SPACING)
        self.alliances = {
            wpilib.DriverStation.Alliance.kRed: LEDPattern.solid(Color.kRed).breathe(2),
            wpilib.DriverStation.Alliance.kBlue: LEDPattern.solid(Color.kBlue).breathe(2),
        }
        self.driving = LEDPattern.gradient(LEDPattern.GradientType.kContinuous, [Color.kOrange, Color.kBlack])
        self.driving = self.driving.scrollAtRelativeSpeed(0.25)
        self.conditions: list[tuple[Callable[[], bool], LEDPattern]] = []

    def show_while(self, condition: Callable[[], bool], pattern: LEDPattern) -> None:
        """Show a pattern while a condition holds and no earlier one does."""
        self.conditions.append((condition, pattern))

    def pattern(self) -> LEDPattern:
        """Return what to show now."""
        if wpilib.DriverStation.isDisabled():
            return self.alliances.get(wpilib.DriverStation.getAlliance(), self.rainbow)
        for condition, pattern in self.conditions:
            if condition():
                return pattern
        return self.driving

    def periodic(self) -> None:
        """Draw."""
        self.pattern().applyTo(self.buffer)
        self.strip.setData(self.buffer)
