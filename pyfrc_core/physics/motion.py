"""Mechanisms that move along a line: from what the motor is set to, to what the encoder counts."""

from __future__ import annotations

from .labels import show_label
from .parameters import ParameterError, finite, not_negative, within_full_power


class LinearMotion:
    """A mechanism such as an elevator, with an encoder directly coupled to its motor, which follows its input at once.

    Its position is shown in the simulator, in feet, under its name. It starts at 0, or at the limit nearest to that.
    """

    #: Position in feet.
    position_ft: float = 0.0
    #: Position in encoder ticks, counted from 0 ft; a tick counts when it is complete.
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
        :param motor_ft_per_sec: speed at full power, in ft/s; negative if the motor is mounted the other way round
        :param ticks_per_feet: what the encoder counts in a foot; negative if it counts the other way
        :param max_position: where the mechanism ends, in feet; None if it does not
        :param min_position: where it begins, in feet; None if it does not
        :raises ParameterError: for what is not a number, or limits that leave no room
        """
        self._name = name
        self._speed = finite(motor_ft_per_sec, "motor_ft_per_sec")
        self._ticks_per_feet = finite(ticks_per_feet, "ticks_per_feet")
        self._max = float("inf") if max_position is None else finite(max_position, "max_position")
        self._min = float("-inf") if min_position is None else finite(min_position, "min_position")
        if self._min > self._max:
            raise ParameterError(
                f"min_position = {min_position!r} is above max_position = {max_position!r}",
                remedy="min_position is 0 unless given; None for no limit",
            )
        self._last_call: float | None = None
        self._move(0.0)

    def compute(self, motor_val: float, tm_diff: float | None = None) -> int:
        """Move on, and answer the new position in ticks.

        :param motor_val: what the motor was set to, -1 to 1; values beyond count as full power
        :param tm_diff: for how many seconds. If left out, the robot time since the previous call; the first
            call then moves nothing
        :raises ParameterError: for NaN, or a time below zero
        """
        motor_val = within_full_power(motor_val, "motor_val")
        tm_diff = self._time_since_last_call() if tm_diff is None else not_negative(tm_diff, "tm_diff")
        self._move(self._speed * motor_val * tm_diff)
        return self.position_ticks

    def _move(self, feet: float) -> None:
        self.position_ft = min(max(self.position_ft + feet, self._min), self._max)
        # Rounded before it is cut off: many small steps add up to a little less than the whole.
        self.position_ticks = int(round(self.position_ft * self._ticks_per_feet, 6))
        show_label(self._name, f"{round(self.position_ft, 2) + 0.0:.2f}")

    def _time_since_last_call(self) -> float:
        import wpilib

        now, last = wpilib.Timer.getFPGATimestamp(), self._last_call
        self._last_call = now
        # Below zero when the motion has outlived one robot and meets the next, whose time begins anew.
        return 0.0 if last is None else max(0.0, now - last)
