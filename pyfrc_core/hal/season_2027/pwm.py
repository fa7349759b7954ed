"""PWM outputs: the power of a motor controller is a value of a SimDevice, which `hal_data` shows with the channel."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from wpilib.simulation import PWMSim

from ...wpi.season_2027 import sim_devices

_VALUE = "Throttle"


class MotorPwmSim(PWMSim):
    """A PWM channel, with the power of the motor controller there, if the robot has made one."""

    def __init__(self, channel: int) -> None:
        super().__init__(channel)
        self._name = f"{sim_devices.PWM_MOTOR}{channel}]"
        self._handle = 0
        self._throttle: sim_devices.SimValue | None = None

    def throttle(self) -> sim_devices.SimValue | None:
        """Return the access to the power; None without a motor controller."""
        handle = sim_devices.handle_of(self._name)
        if handle != self._handle:
            self._handle = handle
            self._throttle = sim_devices.access(sim_devices.open_device(self._name), _VALUE) if handle else None
        return self._throttle

    def get_throttle(self) -> float:
        """Return the power, from -1 to 1; 0 without a motor controller."""
        throttle = self.throttle()
        return 0.0 if throttle is None else float(throttle.get())

    def set_throttle(self, power: float) -> None:
        """Set the power that `hal_data` shows. Without a motor controller, this has no effect."""
        throttle = self.throttle()
        if throttle is not None:
            throttle.set(power)

    def register_throttle_callback(self, callback: Callable[..., object], notify: bool) -> object:
        """Call a function when the power is set, for as long as the result is kept.

        WPILib sets the pulse after the power; until the robot has made the motor controller, only the pulse reports.
        """
        store: list[Any] = []

        def changed() -> None:
            callback()

        def connect() -> None:
            throttle = self.throttle()
            if throttle is not None and not store:
                store.append(sim_devices.watch(throttle, changed))

        def pulsed(*_: object) -> None:
            connect()
            changed()

        connect()
        return self.register_pulse_microsecond_callback(pulsed, False), store
