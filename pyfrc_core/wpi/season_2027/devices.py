"""Devices: which one an object of the robot's is, the values of SimDevices, and the battery's voltage."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import hal
import hal.simulation
import wpilib
from wpilib.simulation import RoboRioSim, SimDeviceSim

from ..device_values import Sensor, SimValue, SimValueKind, find_sensor
from . import imu, sparks

_reset_all = hal.simulation.reset_all_sim_data


def reset_all() -> None:
    """Reset all devices of the simulated HAL to their initial values; WPILib leaves out the IMU."""
    _reset_all()
    for value in imu.VALUES:
        for number in (1.0, 0.0):  # the HAL takes -0.0 for 0.0, and would keep it
            imu.writer(value)(number)


#: Return the battery's voltage.
battery_voltage = RoboRioSim.get_vin_voltage

WiredKind = Literal[
    "encoder",
    "double solenoid",
    "duty cycle encoder",
    "pwm",
    "digital",
    "analog input",
    "solenoid",
]

#: The classes of each kind; the first that fits is the one.
_KINDS: tuple[tuple[WiredKind, tuple[type[Any], ...]], ...] = (
    ("encoder", (wpilib.Encoder,)),
    ("double solenoid", (wpilib.DoubleSolenoid,)),
    ("duty cycle encoder", (wpilib.DutyCycleEncoder,)),
    ("pwm", (wpilib.PWMMotorController, wpilib.PWM)),
    ("digital", (wpilib.DigitalInput, wpilib.DigitalOutput)),
    ("analog input", (wpilib.AnalogInput,)),
    ("solenoid", (wpilib.Solenoid,)),
)


def wired_kind(thing: object) -> WiredKind | None:
    """Return which of WPILib's devices at a channel an object is; None for everything else."""
    return next((kind for kind, classes in _KINDS if isinstance(thing, classes)), None)


def channels_of(thing: Any, kind: WiredKind) -> tuple[int, ...]:
    """Return the channels of a device: of a double solenoid two, of an encoder its index in the HAL."""
    if kind == "encoder":
        return (thing.get_fpga_index(),)
    if kind == "double solenoid":
        return thing.get_fwd_channel(), thing.get_rev_channel()
    if kind == "duty cycle encoder":
        return (thing.get_source_channel(),)
    return (thing.get_channel(),)


#: What a sensor is, by the name of its class: a vendor's library need not be installed.
_SENSORS: dict[str, Callable[[Any], Sensor]] = {
    "DigitalInput": lambda each: Sensor(("dio", each.get_channel()), f" on DIO {each.get_channel()}"),
    "AnalogInput": lambda each: Sensor(("analog_in", each.get_channel()), f" on analog input {each.get_channel()}"),
    "AnalogEncoder": lambda each: Sensor(("analog_in", each.get_channel()), f" on analog input {each.get_channel()}"),
    "Encoder": lambda each: Sensor(("encoder", each.get_fpga_index())),
    "DutyCycleEncoder": lambda each: Sensor(
        ("CAN", f"DutyCycle:DutyCycleEncoder[{each.get_source_channel()}]"), f" on DIO {each.get_source_channel()}"
    ),
    "OnboardIMU": lambda each: Sensor(("onboard_imu",)),
    "SparkMax": lambda each: Sensor(("CAN", sparks.device_of(each))),
    "SparkFlex": lambda each: Sensor(("CAN", sparks.device_of(each))),
}


def sensor(thing: object) -> Sensor | None:
    """Return what a sensor is in `hal_data`; None for other objects, and for one that is closed."""
    return find_sensor(thing, _SENSORS)


_SIM_KINDS: dict[hal.Type, SimValueKind] = {
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
    for name, is_output in sim.enumerate_values():
        kind = _SIM_KINDS[sim.get_value(name).type]
        options = SimDeviceSim.get_enum_options(sim.get_enum(name)) if kind == "option" else ()
        found.append(SimValue(name, is_output, kind, tuple(options)))
    return found


def sim_integer(device: str, value: str) -> Callable[[], int]:
    """Return the function that reads an integer of a SimDevice, which exists."""
    return SimDeviceSim(device).get_int(value).get


#: The class of CAN devices that WPILib drives; two of them can have the same ID.
CanDevice = wpilib.CAN


def can_key(bus: Any, id: int, *kind: object) -> tuple[int, str, object]:
    """Return ID, bus and kind of a `CanDevice`, from the arguments of its constructor."""
    return id, bus.name, kind
