"""The LED strip: the alliance, what the robot holds, and whether it can shoot."""

from collections.abc import Callable

from commands2 import Subsystem
from wpilib import AddressableLED, Color, DriverStation, LEDPattern

from constants import LED_COUNT


class Leds(Subsystem):
    """Shows one pattern, chosen in each loop."""

    def __init__(self, loaded: Callable[[], bool], ready: Callable[[], bool]) -> None:
        super().__init__()
        self.strip = AddressableLED(0)
        self.strip.setLength(LED_COUNT)
        self.buffer = [AddressableLED.LEDData() for _ in range(LED_COUNT)]
        self.strip.setData(self.buffer)
        self.strip.start()
        self.loaded = loaded
        self.ready = ready
        self.rainbow = LEDPattern.rainbow(255, 96).scrollAtRelativeSpeed(0.4)
        self.red = LEDPattern.solid(Color.kRed)
        self.blue = LEDPattern.solid(Color.kBlue)
        self.holding = LEDPattern.solid(Color.kOrange).blink(0.2)
        self.shooting = LEDPattern.solid(Color.kGreen)

    def pattern(self) -> LEDPattern:
        """Return what to show now."""
        if DriverStation.isDisabled():
            return self.rainbow
        if self.ready():
            return self.shooting
        if self.loaded():
            return self.holding
        return self.red if DriverStation.getAlliance() == DriverStation.Alliance.kRed else self.blue

    def periodic(self) -> None:
        """Write the pattern to the strip."""
        self.pattern().applyTo(self.buffer)
        self.strip.setData(self.buffer)
