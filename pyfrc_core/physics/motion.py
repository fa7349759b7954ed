"""Mechanisms that move along a line: from a motor's value to an encoder's count."""

from __future__ import annotations

from ..runtime.patches.install import patches
from ..wpi import timing
from .parameters import ParameterError, finite, not_negative, within_full_power


class LinearMotion:
    """A mechanism such as an elevator, with an encoder coupled directly to its motor. It reacts to its motor at once.

    Its position in feet is in ``hal_data["custom"]``, and in the simulator, under its name. It starts at 0, or at the
    nearest limit. Without `max_position` it has no limits, as the wheel of a drivetrain; `min_position` has no effect
    then.
    """

    #: Position in feet.
    position_ft: float = 0.0
    #: Position in whole encoder ticks, from 0 ft.
    position_ticks: int = 0

    def __init__(
        self,
        name: str,
        motor_ft_per_sec: float,
        ticks_per_feet: float,
        max_position: float | None = None,
        min_position: float | None = 0,
    ) -> None:
        """
        :param name: the label in the simulator
        :param motor_ft_per_sec: speed at full power, in ft/s; negative if the motor is mounted in reverse
        :param ticks_per_feet: encoder ticks per foot; negative if the encoder counts in reverse
        :param max_position: the upper limit, in feet; None for no limits
        :param min_position: the lower limit, in feet, if there is an upper one; None for no lower limit
        :raises ParameterError: when a value is not a number, or the limits are in the wrong order
        """
        self.name = name
        self.motor_ft_per_sec = finite(motor_ft_per_sec, "motor_ft_per_sec")
        self.ticks_per_feet = finite(ticks_per_feet, "ticks_per_feet")
        self.max_position = None if max_position is None else finite(max_position, "max_position")
        self.min_position = None if min_position is None else finite(min_position, "min_position")
        if self.min_position is not None and self.max_position is not None and self.min_position > self.max_position:
            raise ParameterError(
                f"min_position = {min_position!r} is above max_position = {max_position!r}",
                remedy="min_position is 0 unless given; None for no limit",
            )
        self._last_call: float | None = None
        self._move(0.0)

    def compute(self, motor_val: float, tm_diff: float | None = None) -> int:
        """Move the mechanism, and return the new position in ticks.

        :param motor_val: the motor's value, -1 to 1; values beyond count as full power
        :param tm_diff: the duration in seconds. The default is the robot time since the previous call; then the first
            call moves nothing
        :raises ParameterError: for NaN, or a time below zero
        """
        motor_val = within_full_power(motor_val, "motor_val")
        tm_diff = self._time_since_last_call() if tm_diff is None else not_negative(tm_diff, "tm_diff")
        self._move(self.motor_ft_per_sec * motor_val * tm_diff)
        return self.position_ticks

    def _move(self, feet: float) -> None:
        position = self.position_ft + feet
        if self.max_position is not None:  # as in 2019, also for `min_position`
            if self.min_position is not None:
                position = max(position, self.min_position)
            position = min(position, self.max_position)
        self.position_ft = position
        # Rounded before it is truncated: many small steps add up to slightly less than the whole.
        self.position_ticks = int(round(position * self.ticks_per_feet, 6))
        if patches.run is not None:  # a robot is running
            patches.run.hal_data["custom"][self.name] = position

    def _time_since_last_call(self) -> float:
        now, last = timing.seconds(), self._last_call
        self._last_call = now
        # Negative when the object is used with a second robot, whose time starts at zero again.
        return 0.0 if last is None else max(0.0, now - last)
