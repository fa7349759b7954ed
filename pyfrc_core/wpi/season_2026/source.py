"""Python code that pyfrc writes for a robot's ``physics.py``: how the season spells it. It imports no WPILib."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import NamedTuple

#: The class that all robots have.
ROBOT = "wpilib.RobotBase"
#: The call with which robot code says what one count of an encoder is.
SETS_DISTANCE = "setDistancePerPulse()"


class SimulationCode(NamedTuple):
    """The simulation of a device.

    :param name: the name to import, see `imports`
    :param made: the expression that makes it
    """

    name: str
    made: str


#: The name of an encoder's simulation.
ENCODER = "EncoderSim"


def imports(simulations: Iterable[str], *, motors: bool) -> str:
    """Return the lines that import WPILib, the simulations of these names, and, if asked for, what `motor` needs."""
    names = ", ".join(sorted(simulations))
    lines = ["import wpilib"]
    lines += [f"from wpilib.simulation import {names}"] if names else []
    lines += ["from wpimath.system.plant import DCMotor"] if motors else []
    return "".join(f"{line}\n" for line in lines)


def motor(model: str, count: int | str) -> str:
    """Return the expression for motors of one model; `motors.usual_motor` has names of models."""
    return f"DCMotor.{model}({count})"


def pwm(channel: int) -> SimulationCode:
    """Return the simulation of a PWM output."""
    return SimulationCode("PWMSim", f"PWMSim({channel})")


def power_of_pwm(expression: str) -> str:
    """Return the expression for the power that a PWM output has."""
    return f"{expression}.getSpeed()"


def encoder(channels: tuple[int, int] | None, index: int) -> SimulationCode:
    """Return the simulation of an encoder, by its first channel if that is known."""
    how = f"createForChannel({channels[0]})" if channels else f"createForIndex({index})"
    return SimulationCode(ENCODER, f"{ENCODER}.{how}")


def analog_gyro(channel: int) -> SimulationCode:
    """Return the simulation of an analog gyro."""
    return SimulationCode("AnalogGyroSim", f"AnalogGyroSim({channel})")


def turned_gyro(expression: str, turned: str, rate: str) -> list[str]:
    """Return the lines that turn an analog gyro.

    :param turned: what is added to its angle, with a sign and spaces: `` - turned``
    :param rate: its rate
    """
    return [f"{expression}.setAngle({expression}.getAngle(){turned})", f"{expression}.setRate({rate})"]


def number(device: str, value: str) -> SimulationCode:
    """Return a number of a SimDevice, with ``get`` and ``set``."""
    made = f"SimDeviceSim({_quoted(device)}).getDouble({_quoted(value)})"
    return SimulationCode("SimDeviceSim", made)


def wheel_speed(speeds: str, wheel: str) -> str:
    """Return the speed of a wheel in WPILib's wheel speeds.

    :param wheel: ``left`` or ``right``, of a mecanum drive such as ``front_left``
    """
    first, *rest = wheel.split("_")
    return f"{speeds}.{first}" + "".join(map(str.capitalize, rest))


def _quoted(text: str) -> str:
    """Return `text` as a Python literal."""
    return json.dumps(text, ensure_ascii=False)
