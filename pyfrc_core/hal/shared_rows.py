"""The rows of the device tables that are the same in each season: the driver station's, and modules on the CAN bus."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from operator import attrgetter
from typing import Any

from ..season import CURRENT
from .containers import NOT_SET
from .fields import (
    HAS_SOURCE,
    INITIALIZED,
    DeviceField,
    DeviceKind,
    Input,
    Measured,
    Output,
    Quantity,
    Shown,
    later,
    named,
)
from .kinds import BOOL, FLOAT, INT32, ValueKind, choice, number, whole

_SEASON = f"{__package__}.season_{CURRENT.year}"
_WPI = f"pyfrc_core.wpi.season_{CURRENT.year}"
_station = partial(later, module=f"{_SEASON}.driver_station")
_pneumatics = partial(later, module=f"{_SEASON}.pneumatics")

HUB_COMPRESSOR_MODE = choice({"disabled": 0, "digital": 1, "analog": 2, "hybrid": 3})

CHANNELS = 24  # of a power distribution module

STATION = choice(
    {"unknown": 0, "red1": 1, "red2": 2, "red3": 3, "blue1": 4, "blue2": 5, "blue3": 6},
    later("AllianceStationID", "hal"),
)


def station_sim() -> Any:
    """Return WPILib's class for the simulated driver station."""
    return named("DriverStationSim")


def controller_sim() -> Any:
    """Return WPILib's class for the simulated controller."""
    return named("RoboRioSim")


ENABLED = Input("enabled", "Enabled", BOOL)
#: What the driver station sends after the modes.
ATTACHED = (
    Input("eStop", "EStop", BOOL, called="emergency stop"),
    Input("dsAttached", "DsAttached", BOOL, called="driver station attached"),
    Input("fmsAttached", "FmsAttached", BOOL, called="field attached"),
    HAS_SOURCE,
)
_REMAINING = Input("remaining", "MatchTime", FLOAT, called="seconds left")
_TIME = (_REMAINING, DeviceField("program_start", default=0.0), HAS_SOURCE)
TIME = DeviceKind("time", _TIME, station_sim, exists="", stays=True)
_ALLIANCE = Input("alliance_station", "AllianceStationId", STATION, called="alliance station")
ALLIANCE = DeviceKind("", (_ALLIANCE,), station_sim, exists="", stays=True)
_STATE = DeviceField("user_program_state", get=lambda _: later("program_state", f"{_WPI}.station")())
PROGRAM = DeviceKind("", (_STATE,), make=lambda: True, exists="")


def battery(name: str) -> DeviceField:
    """Return the supply of the controller.

    :param name: WPILib's name for it
    """
    tooltip = f"The voltage that the {CURRENT.controller.name} gets from the battery"
    shown = Shown("slider", "Battery", tooltip, 0.0, 14.0, 2, "V")
    return Measured("vin_voltage", name, FLOAT, quantity="battery", called="battery voltage", shown=shown)


_OF_A_RAIL: tuple[tuple[str, str, ValueKind, Quantity], ...] = (
    ("Voltage", "Voltage", FLOAT, "rail"),
    ("Current", "Current", FLOAT, "amperes"),
    ("Active", "Enabled", BOOL, "switch"),
    ("Faults", "FaultCount", INT32, "whole"),
)


def rail(rail: str) -> Iterator[DeviceField]:
    """Return the values of a supply of the controller's, which are varied for code that asks for them.

    :param rail: the end of WPILib's names, such as ``3V3``
    """
    for what, asked, kind, quantity in _OF_A_RAIL:
        name, hal = f"user_{what}_{rail.strip('_')}".lower(), f"User{what}{rail}"
        yield Measured(name, hal, kind, recorded=False, quantity=quantity, asked_by=asked + rail)


#: The pulse that stops a PWM motor controller, in microseconds: within the deadband of all of them. Not 0, as on the
#: robot's wire, since physics that computes with pulses would treat it as full speed backwards.
NEUTRAL_US = 1500


def motor(name: str) -> DeviceField:
    """Return what a PWM channel sends to a motor controller.

    :param name: WPILib's name for it
    """
    shown = Shown("meter", "{}", "{}: what the robot sends to the motor, from -1 to 1", -1.0)
    return Output("value", name, number(-1, 1), unset=NOT_SET, off=0.0, shown=shown)


_CLICK = "{}: an input, click to change it"
DIGITAL = Measured(
    "value", "Value", BOOL, unset=False, only_if="is_input", quantity="switch", shown=Shown("switch", "{}", _CLICK)
)
_VOLTS = Shown("slider", "{}", "{}: the voltage that the robot measures", 0.0, CURRENT.controller.analog_volts, 2, "V")
ANALOG = (
    Measured("voltage", "Voltage", FLOAT, quantity="volts", shown=_VOLTS),
    DeviceField("avg_voltage", "Voltage", FLOAT, same_as="voltage", recorded=False),
)
_COUNTS = "{}: its counts, of {distance_per_pulse:g} distance units each. Click the number to change it"
COUNT = (
    Measured("count", "Count", INT32, quantity="count", shown=Shown("number", "Encoder {}", _COUNTS, decimals=0)),
    DeviceField("value", "Count", INT32, same_as="count", recorded=False),
)
_DUTY_CYCLE = Shown("meter", "{}  (DIO as PWM)", "Its duty cycle, 0 to 1")
PWM_ON_DIO = (
    INITIALIZED,
    Output("duty_cycle", "DutyCycle", FLOAT, unset=NOT_SET, shown=_DUTY_CYCLE),
    DeviceField("pin", "Pin", INT32),
)
_MEASURED_CYCLE = Shown("slider", "Duty cycle {}", "The duty cycle that the robot measures")
DUTY_CYCLE = (
    INITIALIZED,
    Measured("frequency", "Frequency", INT32, quantity="hertz"),
    Measured("output", "Output", FLOAT, quantity="turns", shown=_MEASURED_CYCLE),
)


def _led_data(value: Any) -> list[Any]:
    colours = [[whole(0, 255).convert(part) for part in colour] for colour in value]
    if any(len(colour) != 3 for colour in colours):
        raise ValueError
    return [named("AddressableLED.LEDData", "wpilib")(*colour) for colour in colours]


_RGB = attrgetter("r", "g", "b")
_COLOURS = ValueKind(
    "a list of [red, green, blue], each 0 to 255", _led_data, [], load=lambda data: list(map(list, map(_RGB, data)))
)
LED_DATA = Output("data", "Data", _COLOURS, shown=Shown("leds", "LEDs {}", "The colours of the LED strip"))

#: What the driver station sends of the match, and the joysticks. Their values are in `driver_station`.
DRIVER_STATION = (
    DeviceKind(
        "event",
        (Input("game_specific_message", called="game message"),),
        build=_station("EventData"),
        exists="",
        stays=True,
    ),
    DeviceKind(
        "joysticks",
        tuple(Input(each, stays=False) for each in ("axes", "buttons", "povs")),
        build=_station("joysticks"),
        exists="",
        stays=True,
    ),
)


def _solenoid(module: str) -> DeviceField:
    shown = Shown("lamps", f"{module} {{}}", f"The solenoids of {module} {{}}, from 0")
    return Output("value", "SolenoidOutput", BOOL, unset=False, off=False, shown=shown)


def _compressor(module: str) -> tuple[DeviceField, ...]:
    on = Shown("lamp", f"{module} {{}} compressor", "Whether it runs")
    switch = Shown("switch", f"{module} {{}} pressure switch", "Whether the pressure is high enough")
    return (
        INITIALIZED,
        DeviceField("on", "CompressorOn", BOOL, shown=on),
        Measured("pressure_switch", "PressureSwitch", BOOL, quantity="switch", shown=switch),
        DeviceField("current", "CompressorCurrent", FLOAT),
        HAS_SOURCE,
    )


PCM_COMPRESSOR = (*_compressor("PCM"), DeviceField("closed_loop_enabled", "ClosedLoopEnabled", BOOL))
HUB_COMPRESSOR = (
    *_compressor("PH"),
    DeviceField("config_type", "CompressorConfigType", HUB_COMPRESSOR_MODE),
    DeviceField(
        "closed_loop_enabled",
        "CompressorConfigType",
        BOOL,
        same_as="config_type",
        recorded=False,
        get=_pneumatics("is_closed_loop"),
        put=_pneumatics("set_closed_loop"),
    ),
)
_VOLTAGE = Shown("slider", "PDP {}", "Power distribution {}: its voltage", 0.0, 14.0, 2, "V")
DISTRIBUTION = (
    INITIALIZED,
    Measured("voltage", "Voltage", FLOAT, quantity="battery", shown=_VOLTAGE),
    Measured("temperature", "Temperature", FLOAT, quantity="celsius", asked_by="Temperature"),
    DeviceField("total_power", default=0.0),
    DeviceField("total_energy", default=0.0),
)
_BARS = Shown(
    "bars", "   Currents", "Power distribution {}: the current of each channel, up to 40 A", 0.0, 40.0, 1, "A"
)
#: The part of a power distribution that is a list.
CURRENTS = Measured("current", kind=FLOAT, quantity="amperes", length=CHANNELS, shown=_BARS)

#: Modules on the CAN bus, by their numbers. Their values are in `modules`.
MODULES = (
    DeviceKind("pcm", (_solenoid("PCM"),), by_number=True, panel="Pneumatics", labels="solenoid"),
    DeviceKind("ph", (_solenoid("PH"),), by_number=True, panel="Pneumatics", labels="solenoid"),
    DeviceKind("pcm_compressor", PCM_COMPRESSOR, by_number=True, panel="Pneumatics"),
    DeviceKind("ph_compressor", HUB_COMPRESSOR, by_number=True, panel="Pneumatics"),
    DeviceKind("pdp", (*DISTRIBUTION, CURRENTS), by_number=True, seldom=True, panel="Power"),
)
