"""The LED strip tells the drivers what the robot is about to do."""

import wpilib
from constants import LED_COUNT, PWM_LEDS
from magicbot import tunable
from wpilib import Color, LEDPattern

from .indexer import Indexer
from .shooter import Shooter


class Lights:
    """Colours by what matters most at the moment."""

    shooter: Shooter
    indexer: Indexer

    brightness = tunable(0.6)

    def setup(self) -> None:
        """Start the strip."""
        self.strip = wpilib.AddressableLED(PWM_LEDS)
        self.strip.setLength(LED_COUNT)
        self.buffer = [wpilib.AddressableLED.LEDData() for _ in range(LED_COUNT)]
        self.strip.setData(self.buffer)
        self.strip.start()
        spacing = 1 / LED_COUNT
        self.rainbow = LEDPattern.rainbow(255, 160).scrollAtRelativeSpeed(0.4)
        self.red = LEDPattern.solid(Color.kRed).breathe(2.0)
        self.blue = LEDPattern.solid(Color.kBlue).breathe(2.0)
        self.ready = LEDPattern.solid(Color.kGreen)
        self.spinning = LEDPattern.solid(Color.kOrange).mask(LEDPattern.progressMaskLayer(self.spun_up))
        self.full = LEDPattern.solid(Color.kWhite).blink(0.2)
        self.scroll = LEDPattern.gradient(LEDPattern.GradientType.kContinuous, [Color.kPurple, Color.kBlack])
        self.scroll = self.scroll.scrollAtAbsoluteSpeed(0.5, spacing)

    def spun_up(self) -> float:
        """Return how much of its speed the shooter has, from 0 to 1."""
        return self.shooter.rpm / self.shooter.target if self.shooter.target else 0.0

    def pattern(self) -> LEDPattern:
        """Return what to show."""
        if wpilib.DriverStation.isEStopped():
            return LEDPattern.solid(Color.kRed)
        if wpilib.DriverStation.isDisabled():
            if not wpilib.DriverStation.isDSAttached():
                return self.rainbow
            alliance = wpilib.DriverStation.getAlliance()
            return self.red if alliance == wpilib.DriverStation.Alliance.kRed else self.blue
        if self.shooter.is_ready():
            return self.ready
        if self.shooter.target > self.shooter.idle_rpm:
            return self.spinning
        return self.full if self.indexer.is_full() else self.scroll

    def show(self) -> None:
        """Show the pattern: in each loop, also while disabled."""
        self.pattern().atBrightness(self.brightness).applyTo(self.buffer)
        self.strip.setData(self.buffer)

    def execute(self) -> None:
        """Nothing more is to do while enabled."""
