"""Find motors that autonomous has set, and that run on in teleop although no code sets them.

Only the field's order counts: autonomous, then teleop. In other orders (drivers practise, then try autonomous), correct
robots have motors that keep their values, too.

Commands of commands2 that never end need no check of this kind: the scheduler cancels them when the robot is disabled,
and the field disables it between two modes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import CodeType, FrameType
from typing import Any

from ...project.robot_files import RobotFiles
from ...wpi import motor_controllers
from .failure import user_frame

#: How long after the beginning of teleop a motor may still have its value from autonomous.
STOPS_WITHIN_US = 1_000_000
#: Powers up to this one do not move a motor.
NEGLIGIBLE_POWER = 0.02


@dataclass
class SetMotor:
    """A motor that was set in autonomous.

    :param code: the function of the robot's that has set it, if it is known
    :param line: its line
    :param power: the power of the motor when autonomous ended
    """

    motor: Any
    code: CodeType | None
    line: int
    power: float = 0.0


class MotorsLeftRunning:
    """Notes which motors autonomous has set, and finds those that still run in teleop, with no code setting them.

    It knows of PWM motor controllers, which move only by what robot code sets. A controller on the CAN bus may be under
    one of its own control modes instead.

    :param in_group: returns whether a motor belongs to a drive or a group, which sets it without a call in Python
    """

    def __init__(self, in_group: Callable[[object], bool]) -> None:
        self._in_group = in_group
        #: Whether calls are to be noted: in autonomous, and until no motor is left that it has set.
        self.counts_calls = False
        self._mode = ""
        self._mode_since_us = 0
        self._set: dict[int, SetMotor] = {}

    def on_call(self, motor: object, frame: FrameType, files: RobotFiles) -> None:
        """Note a call that sets a motor.

        :param frame: where it is called
        """
        if self._mode != "autonomous":
            self._set.pop(id(motor), None)
            self.counts_calls = bool(self._set)
        elif motor_controllers.is_pwm(motor):
            caller = user_frame(frame, files)
            code, line = (caller.f_code, caller.f_lineno) if caller is not None else (None, 0)
            self._set[id(motor)] = SetMotor(motor, code, line)

    def on_mode(self, mode: str, now_us: int) -> None:
        """Note a new mode, before the robot reacts to it."""
        if self._mode == "autonomous":
            for noted in list(self._set.values()):
                noted.power = motor_controllers.power_of(noted.motor)
        elif mode in ("autonomous", "test"):
            self._set.clear()
        self._mode, self._mode_since_us = mode, now_us
        self.counts_calls = mode == "autonomous" or bool(self._set)

    def found(self, now_us: int) -> Sequence[SetMotor]:
        """Return the motors that still run, each once."""
        if not self._set or self._mode != "teleop" or now_us - self._mode_since_us < STOPS_WITHIN_US:
            return ()
        noted = list(self._set.values())
        self._set.clear()
        return [each for each in noted if self._runs_on(each)]

    def _runs_on(self, noted: SetMotor) -> bool:
        now = motor_controllers.power_of(noted.motor)
        return abs(noted.power) > NEGLIGIBLE_POWER and now == noted.power and not self._in_group(noted.motor)
