"""Shoot what is loaded."""

from components.feedercontrol import FeederControl
from magicbot import AutonomousStateMachine, timed_state


class Shoot(AutonomousStateMachine):
    MODE_NAME = "Shoot"
    DEFAULT = True
    feeder_control: FeederControl

    @timed_state(first=True, duration=5.0)
    def shoot(self) -> None:
        self.feeder_control.shoot()
