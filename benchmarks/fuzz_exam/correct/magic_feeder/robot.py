"""A MagicRobot with a feeder's state machine and tunables that may have any value."""

import magicbot
import wpilib
from components.feeder import Feeder
from components.feedercontrol import FeederControl


class MyRobot(magicbot.MagicRobot):
    feeder_control: FeederControl
    feeder: Feeder

    def createObjects(self) -> None:
        self.feeder_motor = wpilib.PWMVictorSPX(0)
        self.feeder_beam = wpilib.DigitalInput(0)
        self.feeder_wheel = wpilib.PWMSparkMax(1)
        self.feeder_encoder = wpilib.Encoder(1, 2)
        self.feeder_encoder.setDistancePerPulse(1 / 2048)
        self.gamepad = wpilib.XboxController(0)

    def teleopPeriodic(self) -> None:
        if self.gamepad.getAButton():
            self.feeder_control.shoot()
        elif self.gamepad.getBButton():
            self.feeder.give_back()
