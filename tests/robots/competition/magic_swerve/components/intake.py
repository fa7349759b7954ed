"""The arm over the bumper, and its roller."""

import rev
import wpilib
from constants import INTAKE_DEPLOYED, INTAKE_STOWED
from magicbot import feedback, tunable, will_reset_to
from wpimath.controller import ArmFeedforward, ProfiledPIDControllerRadians
from wpimath.trajectory import TrapezoidProfileRadians


class Intake:
    """A pivot with a potentiometer, and a roller on a SPARK MAX."""

    roller: rev.SparkMax
    pivot: wpilib.PWMTalonFX
    potentiometer: wpilib.AnalogPotentiometer

    pivot_kp = tunable(9.0)
    roller_speed = tunable(0.85)

    deployed = will_reset_to(False)
    rolling = will_reset_to(0.0)

    def setup(self) -> None:
        """Create the controllers."""
        self.pid = ProfiledPIDControllerRadians(self.pivot_kp, 0, 0.2, TrapezoidProfileRadians.Constraints(4.0, 12.0))
        self.feedforward = ArmFeedforward(kS=0.05, kG=0.28, kV=1.2)

    def on_enable(self) -> None:
        """Begin where the arm hangs."""
        self.pid.reset(self.potentiometer.get())

    def collect(self) -> None:
        """Lower the arm and pull in; call it in each loop."""
        self.deployed, self.rolling = True, self.roller_speed

    def eject(self) -> None:
        """Lower the arm and push out; call it in each loop."""
        self.deployed, self.rolling = True, -self.roller_speed

    def is_down(self) -> bool:
        """Return whether the arm is low enough to collect."""
        return abs(self.potentiometer.get() - INTAKE_DEPLOYED) < 0.12

    @feedback
    def get_angle(self) -> float:
        return self.potentiometer.get()

    @feedback
    def get_goal(self) -> float:
        return self.pid.getGoal().position

    def execute(self) -> None:
        """Move the arm towards its goal, and roll once it is down."""
        self.pid.setP(self.pivot_kp)
        volts = self.pid.calculate(self.potentiometer.get(), INTAKE_DEPLOYED if self.deployed else INTAKE_STOWED)
        setpoint = self.pid.getSetpoint()
        self.pivot.setVoltage(volts + self.feedforward.calculate(setpoint.position, setpoint.velocity))
        self.roller.set(self.rolling if self.is_down() else 0)

    def on_disable(self) -> None:
        """Stop both motors."""
        self.pivot.stopMotor()
        self.roller.stopMotor()
