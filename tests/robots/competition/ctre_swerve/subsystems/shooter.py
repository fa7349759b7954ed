"""The shooter: two wheels whose TalonFX hold a velocity."""

from commands2 import Command, Subsystem
from phoenix6 import BaseStatusSignal
from phoenix6.controls import CoastOut, VelocityVoltage
from phoenix6.hardware import TalonFX
from wpilib import SmartDashboard

from constants import Can, roller_config
from constants import Shooter as Numbers
from subsystems.devices import Connections, configure


class Shooter(Subsystem):
    """Spins its wheels at different speeds, so that the game piece turns in flight."""

    def __init__(self) -> None:
        super().__init__()
        self.top = TalonFX(Can.SHOOTER_TOP)
        self.bottom = TalonFX(Can.SHOOTER_BOTTOM)
        for motor in (self.top, self.bottom):
            configure(motor, roller_config(k_v=0.12, k_p=0.2))
        self.request = VelocityVoltage(0)
        self.coast = CoastOut()
        self.top_velocity = self.top.get_velocity()
        self.bottom_velocity = self.bottom.get_velocity()
        BaseStatusSignal.set_update_frequency_for_all(50, self.top_velocity, self.bottom_velocity)
        self.connections = Connections(self.top, self.bottom)
        self.goals: tuple[float, float] | None = None

    def ready(self) -> bool:
        """Return whether both wheels have their speed."""
        return self.goals is not None and all(
            abs(signal.value - goal) < Numbers.TOLERANCE
            for signal, goal in zip((self.top_velocity, self.bottom_velocity), self.goals, strict=True)
        )

    def periodic(self) -> None:
        """Refresh what the motors measure."""
        BaseStatusSignal.refresh_all(self.top_velocity, self.bottom_velocity)
        self.connections.update()
        SmartDashboard.putNumber("Shooter/Top", self.top_velocity.value)
        SmartDashboard.putBoolean("Shooter/Ready", self.ready())

    def _spin(self, top: float, bottom: float) -> None:
        self.goals = top, bottom
        self.top.set_control(self.request.with_velocity(top))
        self.bottom.set_control(self.request.with_velocity(bottom))

    def _coast(self) -> None:
        self.goals = None
        self.top.set_control(self.coast)
        self.bottom.set_control(self.coast)

    def spin(self) -> Command:
        """Return a command that keeps the wheels at the speed for a shot."""
        return self.runEnd(lambda: self._spin(Numbers.TOP, Numbers.BOTTOM), self._coast).withName("Spin")
