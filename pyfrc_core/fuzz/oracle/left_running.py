"""Find motors that a period or an opmode has set, and that run on in another one although no code sets them.

Without opmodes, only the field's order counts: autonomous, then teleop. In other orders (drivers practise, then try
autonomous), correct robots have motors that keep their values, too. An opmode is to stop its motors in its `end`,
whatever is chosen next.

Commands of commands2 that never end need no check of this kind: the scheduler cancels them when the robot is disabled,
and the field disables it between two modes.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import CodeType, FrameType
from typing import Any

from ...project.robot_files import RobotFiles
from ...wpi import motor_controllers
from .failure import user_frame

#: How long after the beginning of the next period or opmode a motor may still have its value from the one before.
STOPS_WITHIN_US = 1_000_000
#: Powers up to this one do not move a motor.
NEGLIGIBLE_POWER = 0.02


@dataclass
class SetMotor:
    """A motor that was set in a period.

    :param motor: returns it; None when it is gone: an opmode may have made it
    :param period: the name of the opmode that has set it, or autonomous
    :param code: the function of the robot's that has set it, if it is known
    :param line: its line
    :param power: the power of the motor when the period ended
    """

    motor: Callable[[], Any]
    period: str
    code: CodeType | None
    line: int
    power: float = 0.0


class MotorsLeftRunning:
    """Notes which motors a period has set, and finds those that still run in the next one, with no code setting them.

    It knows of PWM motor controllers, which move only by what robot code sets. A controller on the CAN bus may be under
    one of its own control modes instead.

    :param motors_of: returns the motors of a drive or a group, which sets them without a call in Python
    :param in_group: returns whether a motor belongs to a drive or a group
    """

    def __init__(self, motors_of: Callable[[object], Sequence[Any]], in_group: Callable[[object], bool]) -> None:
        self._motors_of = motors_of
        self._in_group = in_group
        #: Whether calls are to be noted: in autonomous and in opmodes, and until no motor is left that they have set.
        self.counts_calls = False
        #: The mode, and the name of the opmode that runs in it; "" for none.
        self.during = ("", "")
        #: The opmode that runs, or ran until the robot was disabled: it has a last call of `periodic` then, and `end`.
        self._opmode = ""
        #: What this is called, or the mode.
        self.period = ""
        self._since_us = 0
        self._set: dict[int, SetMotor] = {}

    @property
    def _leaves(self) -> bool:
        """Whether what is set now is to be stopped."""
        return self.during[0] == "autonomous" or bool(self._opmode)

    def on_call(self, motor: object, frame: FrameType, files: RobotFiles) -> None:
        """Note a call that sets a motor.

        :param frame: where it is called
        """
        # Without opmodes, the motors of drives do not count.
        for each in self._motors_of(motor) if self._opmode else (motor,):
            if not self._leaves:
                self._set.pop(id(each), None)
                self.counts_calls = bool(self._set)
            elif motor_controllers.is_pwm(each):
                caller = user_frame(frame, files)
                code, line = (caller.f_code, caller.f_lineno) if caller is not None else (None, 0)
                self._set[id(each)] = SetMotor(weakref.ref(each), self.period, code, line)

    def on_mode(self, mode: str, opmode: str, now_us: int) -> None:
        """Note a new mode or opmode, before the robot reacts to it.

        :param opmode: the name of the opmode that runs now; "" for none
        """
        if self._leaves:
            for noted in self._set.values():
                if noted.period == self.period and (motor := noted.motor()) is not None:
                    noted.power = motor_controllers.power_of(motor)
        elif mode in ("autonomous", "test") and not opmode:
            self._set.clear()
        self.during, self._since_us = (mode, opmode), now_us
        if mode != "disabled" or not self._opmode:
            self._opmode = opmode
            self.period = f"the opmode {opmode}" if opmode else mode
        self.counts_calls = self._leaves or bool(self._set)

    def found(self, now_us: int) -> Sequence[SetMotor]:
        """Return the motors that still run, each once."""
        mode, opmode = self.during
        if not self._set or not (opmode or mode == "teleop") or now_us - self._since_us < STOPS_WITHIN_US:
            return ()
        noted = {key: each for key, each in self._set.items() if each.period != self.period}
        for key in noted:
            del self._set[key]
        return [each for each in noted.values() if self._runs_on(each)]

    def _runs_on(self, noted: SetMotor) -> bool:
        motor = noted.motor()
        if motor is None or abs(noted.power) <= NEGLIGIBLE_POWER:
            return False
        in_group = not self._opmode and self._in_group(motor)
        return motor_controllers.power_of(motor) == noted.power and not in_group
