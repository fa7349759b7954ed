"""Devices: which one an object of the robot's is, the values of SimDevices, and the battery's voltage."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import hal
import wpilib
from wpilib.simulation import RoboRioSim, SimDeviceSim

#: Return the battery's voltage.
battery_voltage = RoboRioSim.getVInVoltage

WiredKind = Literal[
    "encoder",
    "analog gyro",
    "double solenoid",
    "duty cycle encoder",
    "servo",
    "pwm",
    "digital",
    "analog input",
    "relay",
    "solenoid",
]

#: The classes of each kind; the first that fits is the one.
_KINDS: tuple[tuple[WiredKind, tuple[type[Any], ...]], ...] = (
    ("encoder", (wpilib.Encoder,)),
    ("analog gyro", (wpilib.AnalogGyro,)),
    ("double solenoid", (wpilib.DoubleSolenoid,)),
    ("duty cycle encoder", (wpilib.DutyCycleEncoder,)),
    ("servo", (wpilib.Servo,)),
    ("pwm", (wpilib.PWMMotorController, wpilib.PWM)),
    ("digital", (wpilib.DigitalInput, wpilib.DigitalOutput)),
    ("analog input", (wpilib.AnalogInput,)),
    ("relay", (wpilib.Relay,)),
    ("solenoid", (wpilib.Solenoid,)),
)


def wired_kind(thing: object) -> WiredKind | None:
    """Return which of WPILib's devices at a channel an object is; None for everything else."""
    return next((kind for kind, classes in _KINDS if isinstance(thing, classes)), None)


def channels_of(thing: Any, kind: WiredKind) -> tuple[int, ...]:
    """Return the channels of a device: of a double solenoid two, of an encoder its index in the HAL."""
    if kind == "encoder":
        return (thing.getFPGAIndex(),)
    if kind == "analog gyro":
        return (thing.getAnalogInput().getChannel(),)
    if kind == "double solenoid":
        return thing.getFwdChannel(), thing.getRevChannel()
    if kind == "duty cycle encoder":
        return (thing.getSourceChannel(),)
    return (thing.getChannel(),)


class SimValue(NamedTuple):
    """A value of a SimDevice.

    :param is_output: whether only the device itself writes it
    :param kind: its type; ``whole`` is a whole number
    :param options: what an option can be
    """

    name: str
    is_output: bool
    kind: Literal["boolean", "number", "whole", "option"]
    options: tuple[str, ...] = ()


_SIM_KINDS: dict[hal.Type, Literal["boolean", "number", "whole", "option"]] = {
    hal.Type.BOOLEAN: "boolean",
    hal.Type.DOUBLE: "number",
    hal.Type.ENUM: "option",
    hal.Type.INT: "whole",
    hal.Type.LONG: "whole",
}


def sim_values(device: str) -> list[SimValue]:
    """Return the values of a SimDevice."""
    sim = SimDeviceSim(device)
    found = []
    for name, is_output in sim.enumerateValues():
        kind = _SIM_KINDS[sim.getValue(name).type]
        options = SimDeviceSim.getEnumOptions(sim.getEnum(name)) if kind == "option" else ()
        found.append(SimValue(name, is_output, kind, tuple(options)))
    return found


def sim_integer(device: str, value: str) -> Callable[[], int]:
    """Return the function that reads an integer of a SimDevice, which exists."""
    return SimDeviceSim(device).getInt(value).get
