"""The shooter's wheel: it takes a while to come up to speed, and a while to run out."""

import wpilib
import wpilib.simulation
from robot import COUNTS_PER_TURN, WHEEL_MOTOR, MyRobot

from pyfrc.physics.core import PhysicsInterface

FREE_RATE = 80.0  # turns per second at full power
TIME_CONSTANT = 0.5  # seconds
FRICTION = 0.5  # turns per second: slower than that, it stands


class PhysicsEngine:
    """Turns the wheel, and tells its encoder."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        """Take hold of the simulated devices."""
        self.motor = wpilib.simulation.PWMSim(WHEEL_MOTOR)
        self.encoder = wpilib.simulation.EncoderSim(robot.shooter.encoder)
        self.rate = 0.0
        self.turns = 0.0

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 10 ms."""
        target = self.motor.getSpeed() * FREE_RATE
        self.rate += (target - self.rate) * min(1.0, tm_diff / TIME_CONSTANT)
        if target == 0 and abs(self.rate) < FRICTION:
            self.rate = 0.0
        self.turns += self.rate * tm_diff
        self.encoder.setCount(round(self.turns * COUNTS_PER_TURN))
        self.encoder.setRate(self.rate)
