"""A motor of the robot, and where its output can be read."""

from __future__ import annotations

from dataclasses import dataclass

from ...hal import HalData
from .names import DeviceName, one_line


@dataclass(frozen=True)
class Motor:
    """A motor, and where its output can be read.

    :param name: its name in the robot's code
    :param channel: the PWM channel; None for a motor on the CAN bus
    :param device: the name of the SimDevice of its controller there
    :param inverted: whether the robot has inverted it, if that is known
    """

    name: DeviceName
    channel: int | None = None
    device: str = ""
    inverted: bool = False

    @property
    def path(self) -> str:
        """Return the path of its controller in `hal_data`."""
        return f"pwm[{self.channel}]" if self.channel is not None else f"CAN[{self.device}]"

    def __str__(self) -> str:
        place = f"PWM {self.channel}" if self.channel is not None else one_line(self.device)
        return f"{place} ({self.name})" if self.name else place

    def output(self, hal_data: HalData) -> float:
        """Return the output that the robot has set, from -1 to 1."""
        return float(hal_data["pwm"][self.channel]["value"])
