"""The devices of the roboRIO: a table that maps fields to values of WPILib's simulation (see `fields`)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from operator import attrgetter
from typing import Any

import hal
import wpilib
from wpilib import simulation as sim

from ...wpi.encoder_channels import channels_of
from ..containers import NOT_SET, LiveDict, Slot
from ..fields import HAS_SOURCE, INITIALIZED, DeviceField, DeviceKind, group
from ..kinds import BOOL, FLOAT, INT32, INT64, ValueKind, choice, number, text, whole
from . import driver_station
from .counters import COUNTERS, CounterSim
from .digital import DigitalSim

RANGE = choice({"2G": 0, "4G": 1, "8G": 2}, hal.AccelerometerRange)
LED_STATE = choice({"off": 0, "green": 1, "red": 2, "orange": 3}, wpilib.RadioLEDState)

_RGB = attrgetter("r", "g", "b")
_LSB = 1220703e-9  # volts per count of the 12-bit converter, as in the HAL


def _relay_initialized(relay: sim.RelaySim) -> bool:
    return relay.getInitializedForward() or relay.getInitializedReverse()


def _initialize_relay(relay: sim.RelaySim, value: bool) -> None:
    relay.setInitializedForward(value)
    relay.setInitializedReverse(value)


def encoder_channels(index: int) -> dict[str, int | None]:
    """Return the digital channels of an encoder; None where they are not known."""
    channels = channels_of(index) if sim.EncoderSim.createForIndex(index).getInitialized() else None
    a, b = channels or (None, None)
    return {"ASource_Channel": a, "BSource_Channel": b}


def led_data(strip: sim.AddressableLEDSim) -> list[list[int]]:
    """Return the colours as ``[red, green, blue]``, 0 to 255."""
    return list(map(list, map(_RGB, strip.getData())))


def _colours(value: Any) -> list[list[int]]:
    colours = [[whole(0, 255).convert(part) for part in colour] for colour in value]
    if any(len(colour) != 3 for colour in colours):
        raise ValueError
    return colours


def _set_led_data(strip: sim.AddressableLEDSim, colours: list[list[int]]) -> None:
    strip.setData([wpilib.AddressableLED.LEDData(*colour) for colour in colours])


F = DeviceField  # a short name, for a compact table

#: The devices. CONTRIBUTING.md ("Add a device") says what else each needs to be seen in the simulator and in fuzz.
KINDS = (
    DeviceKind(
        "pwm",
        20,
        sim.PWMSim,
        (
            INITIALIZED,
            F("type"),
            F("raw_value", "PulseMicrosecond", INT32, unset=0),
            F("value", "Speed", number(-1, 1), unset=NOT_SET),
            F("position", "Position", number(0, 1), recorded=False, unset=NOT_SET),
            F("period_scale", "PeriodScale", INT32),
            F("zero_latch", "ZeroLatch", BOOL),
            F("elim_deadband", default=False),
        ),
    ),
    DeviceKind(
        "dio",
        26,
        DigitalSim,
        (
            INITIALIZED,
            HAS_SOURCE,
            F("value", "Value", BOOL, unset=False),
            F("is_input", "IsInput", BOOL),
            F("pulse_length", "PulseLength", FLOAT),
            F("filter_idx", "FilterIndex", INT32),
        ),
    ),
    DeviceKind(
        "encoder",
        8,
        sim.EncoderSim.createForIndex,
        (
            INITIALIZED,
            HAS_SOURCE,
            F("count", "Count", INT32),
            F("value", "Count", INT32, same_as="count", recorded=False),
            F("period", "Period", FLOAT),
            F("direction", "Direction", BOOL),
            F("max_period", "MaxPeriod", FLOAT),
            F("reverse_direction", "ReverseDirection", BOOL),
            F("samples_to_average", "SamplesToAverage", INT32),
            F("distance_per_pulse", "DistancePerPulse", FLOAT),
            # WPILib derives both from period, count and distance per pulse, and vice versa.
            F("rate", "Rate", FLOAT, recorded=False),
            F("distance", "Distance", FLOAT, recorded=False),
            F("min_rate", default=0.0),
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
            F("voltage", "Voltage", FLOAT),
            F("avg_voltage", "Voltage", FLOAT, same_as="voltage", recorded=False),
            # The HAL computes both counts from the voltage; because of the margin, truncation returns the count that
            # was set.
            *(
                F(
                    name,
                    "Voltage",
                    whole(0, 4095),
                    same_as="voltage",
                    recorded=False,
                    get=lambda device: int(device.getVoltage() / _LSB),
                    put=lambda device, value: device.setVoltage((value + 1e-6) * _LSB),
                )
                for name in ("value", "avg_value")
            ),
            F("avg_bits", "AverageBits", INT32),
            F("oversample_bits", "OversampleBits", INT32),
            F("accumulator_initialized", "AccumulatorInitialized", BOOL),
            F("accumulator_value", "AccumulatorValue", INT64),
            F("accumulator_count", "AccumulatorCount", INT64),
            F("accumulator_center", "AccumulatorCenter", INT32),
            F("accumulator_deadband", "AccumulatorDeadband", INT32),
            F("lsb_weight", default=1),
            F("offset", default=65535),
        ),
    ),
    DeviceKind(
        "analog_out",
        8,
        sim.AnalogOutputSim,
        (INITIALIZED, F("voltage", "Voltage", FLOAT, unset=NOT_SET)),
        real=2,
    ),
    DeviceKind(
        "analog_gyro",
        2,
        sim.AnalogGyroSim,
        (
            INITIALIZED,
            F("angle", "Angle", FLOAT),
            F("rate", "Rate", FLOAT),
            F("deadband", default=0.0),
            F("volts_per_degree", default=0.0),
            F("offset", default=0.0),
            F("center", default=0),
        ),
    ),
    DeviceKind(
        "analog_trigger",
        8,
        sim.AnalogTriggerSim.createForIndex,
        (
            INITIALIZED,
            F("trig_lower", "TriggerLowerBound", FLOAT),
            F("trig_upper", "TriggerUpperBound", FLOAT),
            F("port", default=0),
            F("trig_type"),
            F("trig_state", default=False),
        ),
    ),
    DeviceKind(
        "relay",
        4,
        sim.RelaySim,
        (
            F(
                "initialized",
                "InitializedForward",
                BOOL,
                recorded=False,
                get=_relay_initialized,
                put=_initialize_relay,
            ),
            F("fwd", "Forward", BOOL, unset=False),
            F("rev", "Reverse", BOOL, unset=False),
        ),
    ),
    DeviceKind(
        "d0_pwm",
        26,
        sim.DigitalPWMSim.createForIndex,
        (INITIALIZED, F("duty_cycle", "DutyCycle", FLOAT, unset=NOT_SET), F("pin", "Pin", INT32)),
        real=6,
    ),
    DeviceKind(
        "duty_cycle",
        8,
        sim.DutyCycleSim.createForIndex,
        (INITIALIZED, F("frequency", "Frequency", INT32), F("output", "Output", FLOAT)),
    ),
    DeviceKind(
        "addressable_led",
        1,
        sim.AddressableLEDSim.createForIndex,
        (
            INITIALIZED,
            F("output_port", "OutputPort", INT32),
            F("length", "Length", whole(0, 5460)),
            F("running", "Running", BOOL, get=lambda strip: bool(strip.getRunning())),
            F(
                "data",
                "Data",
                ValueKind("a list of [red, green, blue], each 0 to 255", _colours, []),
                get=led_data,
                put=_set_led_data,
            ),
        ),
    ),
    DeviceKind("mxp", 16, None, (F("initialized", default=False),)),
    DeviceKind("filter", 3, None, (F("enabled", default=False), F("period", default=0))),
    DeviceKind(
        "counter",
        COUNTERS,
        CounterSim,
        (
            INITIALIZED,
            HAS_SOURCE,
            F("count", "Count", INT32),
            F("direction", "Direction", BOOL),
            F("period", default=0.0),
            F("max_period", default=0.0),
            F("mode", default=0),
            F("reverse_direction", default=False),
            F("samples_to_average", default=0),
            F("update_when_empty", default=False),
            F("average_size", default=0),
            F("pulse_length_threshold", default=0.0),
            *(F(f"{way}_source_{part}") for way in ("up", "down") for part in ("channel", "trigger")),
            *(F(f"{way}_{edge}_edge", default=False) for way in ("up", "down") for edge in ("rising", "falling")),
        ),
    ),
)

ACCELEROMETER = (
    F("active", "Active", BOOL),
    F("range", "Range", RANGE),
    F("x", "X", FLOAT),
    F("y", "Y", FLOAT),
    F("z", "Z", FLOAT),
    HAS_SOURCE,
)
POWER = (
    F("vin_voltage", "VInVoltage", FLOAT),
    F("vin_current", "VInCurrent", FLOAT),
    F("brownout_voltage", "BrownoutVoltage", FLOAT),
    *(
        F(f"user_{what.lower()}_{rail.lower()}", f"User{what}{rail}", kind)
        for rail in ("6V", "5V", "3V3")
        for what, kind in (("Voltage", FLOAT), ("Current", FLOAT), ("Active", BOOL), ("Faults", INT32))
    ),
    HAS_SOURCE,
)
FPGA_BUTTON = F("fpga_button", "FPGAButton", BOOL)
ROBORIO = (
    F("team_number", "TeamNumber", INT32),
    F("serial_number", "SerialNumber", text(8)),
    F("comments", "Comments", text(64)),
    F("cpu_temp", "CPUTemp", FLOAT),
    F("radio_led_state", "RadioLEDState", LED_STATE),
)


def groups() -> dict[str, Callable[[], LiveDict]]:
    """Return what there is only one of, by its key, each with the function that makes it."""
    return {
        "control": lambda: group("control", sim.DriverStationSim, driver_station.CONTROL),
        "time": lambda: group("time", sim.DriverStationSim, driver_station.TIME),
        "accelerometer": lambda: group("accelerometer", sim.BuiltInAccelerometerSim(), ACCELEROMETER),
        "power": lambda: group("power", sim.RoboRioSim, POWER),
        "roborio": lambda: group("roborio", sim.RoboRioSim, ROBORIO),
    }


def values() -> dict[str, Slot]:
    """Return the values that have a key of their own."""
    return {
        "alliance_station": driver_station.ALLIANCE_STATION.slot(sim.DriverStationSim),
        "fpga_button": FPGA_BUTTON.slot(sim.RoboRioSim),
    }


#: The buttons of the controller itself, by their keys.
BUTTONS: tuple[str, ...] = ("fpga_button",)

#: The kinds of `KINDS` that are gyros, with `angle` and `rate`.
GYROS: tuple[str, ...] = ("analog_gyro",)


def turn_analog_gyros(tree: LiveDict, degrees: float) -> None:
    """Turn the gyros at channels of the controller clockwise."""
    for gyro in tree["analog_gyro"]:
        gyro["angle"] += degrees


def set_analog_gyro_rates(tree: LiveDict, degrees: float) -> None:
    """Set how fast they turn clockwise, in degrees per second."""
    for gyro in tree["analog_gyro"]:
        gyro["rate"] = degrees


#: Whether the controller has an IMU, which turns with the robot.
HAS_IMU = False


def turn_imu(tree: LiveDict, degrees: float) -> None:
    """Do nothing: there is none."""


def set_imu_rate(tree: LiveDict, degrees: float) -> None:
    """Do nothing: there is none."""


#: The groups that exist when one of their values says so, with its key.
MAY_EXIST: Mapping[str, str] = {"accelerometer": "active"}
#: Which values of groups that always exist are recorded: the rest is constant, or derived. Physics and robots change
#: the supply and the LED.
RECORDED: Mapping[str, tuple[str, ...]] = {
    "power": ("vin_voltage", "vin_current", "brownout_voltage"),
    "roborio": ("radio_led_state",),
    "time": ("remaining",),
}
RECORDED_VALUES = ("alliance_station", "fpga_button", "user_program_state")
