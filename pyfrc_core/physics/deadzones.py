"""What a motor makes of what it is set to."""

from __future__ import annotations

from collections.abc import Callable

from .parameters import ParameterError, finite, within_full_power

#: What a motor gives, between -1 and 1, for what it is set to.
DeadzoneCallable = Callable[[float], float]


def linear_deadzone(deadzone: float) -> DeadzoneCallable:
    """For a motor that needs some input to move at all: none up to `deadzone`, then growing linearly to full power.

    With 0.2, an input of 0.3 gives 0.125. The same backwards.

    :param deadzone: the least input that moves the motor, from 0 to below 1
    :raises ParameterError: for any other
    """
    deadzone = finite(deadzone, "deadzone")
    if not 0 <= deadzone < 1:
        raise ParameterError(f"deadzone = {deadzone!r}: must be at least 0 and less than 1")
    scale = 1.0 / (1.0 - deadzone)

    def output(motor_input: float) -> float:
        if not -1.0 <= motor_input <= 1.0:
            motor_input = within_full_power(motor_input, "motor_input")
        if motor_input > deadzone:
            return (motor_input - deadzone) * scale
        if motor_input < -deadzone:
            return (motor_input + deadzone) * scale
        return 0.0

    return output


def motor_output(motor_value: float, parameter: str, deadzone: DeadzoneCallable | None) -> float:
    """What the motor gives for what it is set to, between -1 and 1."""
    motor_value = within_full_power(motor_value, parameter)
    return motor_value if deadzone is None else deadzone(motor_value)


def deadzone_function(deadzone: DeadzoneCallable | None) -> DeadzoneCallable | None:
    """`deadzone` as given to a drivetrain, if it can be called.

    :raises ParameterError: if not; many a user gives the number
    """
    if deadzone is None or callable(deadzone):
        return deadzone
    raise ParameterError(
        f"deadzone = {deadzone!r}: must be a function", remedy="for example, drivetrains.linear_deadzone(0.2)"
    )
