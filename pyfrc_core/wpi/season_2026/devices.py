"""Devices: which one an object of the robot's is, the values of SimDevices, and the battery's voltage."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import hal
import hal.simulation
import wpilib
from wpilib.simulation import RoboRioSim, SimDeviceSim

from ..device_values import Sensor, SimValue, SimValueKind, find_sensor
from . import sparks

#: Reset all devices of the simulated HAL to their initial values.
reset_all = hal.simulation.resetAllSimData

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


#: What a sensor is, by the name of its class: a vendor's library need not be installed.
_SENSORS: dict[str, Callable[[Any], Sensor]] = {
    "DigitalInput": lambda each: Sensor(("dio", each.getChannel()), f" on DIO {each.getChannel()}"),
    "AnalogInput": lambda each: Sensor(("analog_in", each.getChannel()), f" on analog input {each.getChannel()}"),
    "AnalogEncoder": lambda each: Sensor(("analog_in", each.getChannel()), f" on analog input {each.getChannel()}"),
    "Encoder": lambda each: Sensor(("encoder", each.getFPGAIndex())),
    "DutyCycleEncoder": lambda each: Sensor(("duty_cycle", each.getFPGAIndex()), f" on DIO {each.getSourceChannel()}"),
    "Ultrasonic": lambda each: Sensor(
        ("CAN", f"Ultrasonic[{each.getEchoChannel()}]"), f" on DIO {each.getEchoChannel()}"
    ),
    "ADXRS450_Gyro": lambda each: Sensor(("CAN", f"Gyro:ADXRS450[{each.getPort()}]")),
    "ADIS16470_IMU": lambda each: Sensor(("CAN", f"Gyro:ADIS16470[{each.getPort()}]")),
    "ADIS16448_IMU": lambda each: Sensor(("CAN", f"Gyro:ADIS16448[{each.getPort()}]")),
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
    for name, is_output in sim.enumerateValues():
        kind = _SIM_KINDS[sim.getValue(name).type]
        options = SimDeviceSim.getEnumOptions(sim.getEnum(name)) if kind == "option" else ()
        found.append(SimValue(name, is_output, kind, tuple(options)))
    return found


def sim_integer(device: str, value: str) -> Callable[[], int]:
    """Return the function that reads an integer of a SimDevice, which exists."""
    return SimDeviceSim(device).getInt(value).get


#: The class of CAN devices that WPILib drives; two of them can have the same ID.
CanDevice = wpilib.CAN


def can_key(id: int, *kind: object) -> tuple[int, str, object]:
    """Return ID, bus and kind of a `CanDevice`, from the arguments of its constructor."""
    return id, "", kind
