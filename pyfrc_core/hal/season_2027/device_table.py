"""The devices of SystemCore: a table that maps fields to values of WPILib's simulation (see `fields`).

What 2026's table has and SystemCore lacks is absent: analog outputs, gyros and triggers, relays, counters, filters, the
accelerometer, the rails of 5 and 6 volts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import radians
from operator import attrgetter
from typing import Any

import wpilib
from wpilib import simulation as sim

from ...wpi.encoder_channels import channels_of
from ...wpi.season_2027 import imu
from ..containers import NOT_SET, LiveDict, Slot
from ..fields import HAS_SOURCE, INITIALIZED, DeviceField, DeviceKind, group
from ..kinds import BOOL, FLOAT, INT32, ValueKind, number, text, whole
from . import driver_station
from .digital import DigitalSim
from .onboard_imu import ImuSim
from .pwm import MotorPwmSim

_RGB = attrgetter("r", "g", "b")
#: The ports of SystemCore at which a channel can be anything.
_SMART_IO = 6


def encoder_channels(index: int) -> dict[str, int | None]:
    """Return the digital channels of an encoder; None where they are not known."""
    channels = channels_of(index) if sim.EncoderSim.create_for_index(index).get_initialized() else None
    a, b = channels or (None, None)
    return {"ASource_Channel": a, "BSource_Channel": b}


def led_data(strip: sim.AddressableLEDSim) -> list[list[int]]:
    """Return the colours as ``[red, green, blue]``, 0 to 255."""
    return list(map(list, map(_RGB, strip.get_data())))


def _colours(value: Any) -> list[list[int]]:
    colours = [[whole(0, 255).convert(part) for part in colour] for colour in value]
    if any(len(colour) != 3 for colour in colours):
        raise ValueError
    return colours


def _set_led_data(strip: sim.AddressableLEDSim, colours: list[list[int]]) -> None:
    strip.set_data([wpilib.AddressableLED.LEDData(*colour) for colour in colours])


F = DeviceField  # a short name, for a compact table
KINDS = (
    DeviceKind(
        "pwm",
        20,
        MotorPwmSim,
        (
            INITIALIZED,
            F("raw_value", "pulse_microsecond", INT32, unset=0),
            F("value", "throttle", number(-1, 1), unset=NOT_SET),
            F("output_period", "output_period", INT32),
        ),
    ),
    DeviceKind(
        "dio",
        31,
        DigitalSim,
        (
            INITIALIZED,
            HAS_SOURCE,
            F("value", "value", BOOL, unset=False),
            F("is_input", "is_input", BOOL),
            F("pulse_length", "pulse_length", FLOAT),
        ),
    ),
    DeviceKind(
        "encoder",
        8,
        sim.EncoderSim.create_for_index,
        (
            INITIALIZED,
            HAS_SOURCE,
            F("count", "count", INT32),
            F("value", "count", INT32, same_as="count", recorded=False),
            F("direction", "direction", BOOL),
            F("reverse_direction", "reverse_direction", BOOL),
            F("distance_per_pulse", "distance_per_pulse", FLOAT),
            F("rate", "rate", FLOAT),
            F("distance", "distance", FLOAT, recorded=False),
        ),
        config=encoder_channels,
    ),
    DeviceKind(
        "analog_in",
        8,
        sim.AnalogInputSim,
        (
            INITIALIZED,
            HAS_SOURCE,
            F("voltage", "voltage", FLOAT),
            F("avg_voltage", "voltage", FLOAT, same_as="voltage", recorded=False),
        ),
    ),
    DeviceKind(
        "d0_pwm",
        _SMART_IO,
        sim.DigitalPWMSim.create_for_index,
        (INITIALIZED, F("duty_cycle", "duty_cycle", FLOAT, unset=NOT_SET), F("pin", "pin", INT32)),
    ),
    DeviceKind(
        "duty_cycle",
        _SMART_IO,
        sim.DutyCycleSim.create_for_channel,
        (INITIALIZED, F("frequency", "frequency", INT32), F("output", "output", FLOAT)),
    ),
    DeviceKind(
        "addressable_led",
        _SMART_IO,
        sim.AddressableLEDSim,
        (
            INITIALIZED,
            F("start", "start", INT32),
            F("length", "length", whole(0, 1024)),
            F(
                "data",
                "data",
                ValueKind("a list of [red, green, blue], each 0 to 255", _colours, []),
                get=led_data,
                put=_set_led_data,
            ),
        ),
    ),
)

POWER = (
    F("vin_voltage", "vin_voltage", FLOAT),
    F("brownout_voltage", "brownout_voltage", FLOAT),
    F("brownout_recovery_voltage", "brownout_recovery_voltage", FLOAT),
    *(
        F(f"user_{what}_3v3", f"user_{what}_3v3", kind)
        for what, kind in (("voltage", FLOAT), ("current", FLOAT), ("active", BOOL), ("faults", INT32))
    ),
    HAS_SOURCE,
)
SYSTEMCORE = (
    F("team_number", "team_number", INT32),
    F("serial_number", "serial_number", text(8)),
    F("comments", "comments", text(64)),
    F("cpu_temp", "cpu_temp", FLOAT),
)


ONBOARD_IMU = (F("active", "active", BOOL), *(F(value, value, FLOAT) for value in imu.VALUES))


def groups() -> dict[str, Callable[[], LiveDict]]:
    """Return what there is only one of, by its key, each with the function that makes it."""
    return {
        "control": lambda: group("control", sim.DriverStationSim, driver_station.CONTROL),
        "time": lambda: group("time", sim.DriverStationSim, driver_station.TIME),
        "onboard_imu": lambda: group("onboard_imu", ImuSim(), ONBOARD_IMU),
        "power": lambda: group("power", sim.RoboRioSim, POWER),
        # The controller's own values, under the key that they had when it was a roboRIO.
        "roborio": lambda: group("roborio", sim.RoboRioSim, SYSTEMCORE),
    }


def values() -> dict[str, Slot]:
    """Return the values that have a key of their own."""
    return {"alliance_station": driver_station.ALLIANCE_STATION.slot(sim.DriverStationSim)}


#: The buttons of the controller itself, by their keys.
BUTTONS: tuple[str, ...] = ()

#: The kinds of `KINDS` that are gyros, with `angle` and `rate`.
GYROS: tuple[str, ...] = ()


def turn_analog_gyros(tree: LiveDict, degrees: float) -> None:
    """Do nothing: there are none."""


def set_analog_gyro_rates(tree: LiveDict, degrees: float) -> None:
    """Do nothing: there are none."""


#: Whether the controller has an IMU, which turns with the robot.
HAS_IMU = True


def turn_imu(tree: LiveDict, degrees: float) -> None:
    """Turn the controller's IMU clockwise. WPILib's yaw is counter-clockwise."""
    gyro = tree["onboard_imu"]
    gyro["yaw"] -= radians(degrees)
    gyro["angle_z"] -= radians(degrees)


def set_imu_rate(tree: LiveDict, degrees: float) -> None:
    """Set how fast it turns clockwise, in degrees per second."""
    tree["onboard_imu"]["gyro_rate_z"] = -radians(degrees)


#: The groups that exist when one of their values says so, with its key.
MAY_EXIST: Mapping[str, str] = {"onboard_imu": "active"}
#: Which values of groups that always exist are recorded: the rest is constant, or derived. Physics changes the supply.
RECORDED: Mapping[str, tuple[str, ...]] = {
    "power": ("vin_voltage", "brownout_voltage"),
    "time": ("remaining",),
}
RECORDED_VALUES = ("alliance_station", "user_program_state")
