"""Dead zones: a motor's output as a function of its input."""

from __future__ import annotations

from collections.abc import Callable

from .parameters import ParameterError, finite, within_full_power

#: Returns a motor's output for its input, both between -1 and 1.
DeadzoneCallable = Callable[[float], float]


def linear_deadzone(deadzone: float) -> DeadzoneCallable:
    """Return a dead zone: no output up to an input of `deadzone`, then a linear increase to full power.

    With 0.2, an input of 0.3 gives 0.125. Negative inputs are treated in the same way.

    :param deadzone: the largest input that does not move the motor, from 0 to below 1
    :raises ParameterError: when `deadzone` is outside that range
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
    """Return a motor's output for its input, between -1 and 1."""
    motor_value = within_full_power(motor_value, parameter)
    return motor_value if deadzone is None else deadzone(motor_value)


def deadzone_function(deadzone: DeadzoneCallable | None) -> DeadzoneCallable | None:
    """Check the `deadzone` parameter of a drivetrain, and return it.

    :raises ParameterError: when it is not a function, for example a number
    """
    if deadzone is None or callable(deadzone):
        return deadzone
    raise ParameterError(
        f"deadzone = {deadzone!r}: must be a function", remedy="for example, drivetrains.linear_deadzone(0.2)"
    )
