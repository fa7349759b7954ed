"""The devices of the roboRIO: a table that says what each value is, and how WPILib's simulation has it (see `fields`).

It imports WPILib only when a device is made.
"""

from __future__ import annotations

from itertools import chain
from typing import Any

from ...season import CURRENT
from ...wpi.encoder_channels import channels_of
from .. import shared_rows as shared
from ..containers import NOT_SET, LiveDict
from ..fields import HAS_SOURCE, INITIALIZED, DeviceField, DeviceKind, Input, Measured, Output, Shown, later, named
from ..kinds import BOOL, FLOAT, INT32, INT64, choice, number, text, whole

#: How many counters a roboRIO has.
COUNTERS = 8

RANGE = choice({"2G": 0, "4G": 1, "8G": 2}, later("AccelerometerRange", "hal"))
LED_STATE = choice({"off": 0, "green": 1, "red": 2, "orange": 3}, later("RadioLEDState", "wpilib"))
_LSB = 1220703e-9  # volts per count of the 12-bit converter, as in the HAL


def _relay_initialized(relay: Any) -> bool:
    return bool(relay.getInitializedForward() or relay.getInitializedReverse())


def _initialize_relay(relay: Any, value: bool) -> None:
    relay.setInitializedForward(value)
    relay.setInitializedReverse(value)


def _drives_motor(pwm: LiveDict) -> bool:
    """Return whether a motor is on. A servo's pulses are 600 to 2400 microseconds, without a deadband in the middle."""
    return bool(pwm["value"]) and abs(600 + 1800 * pwm["position"] - pwm["raw_value"]) > 1


def encoder_channels(index: int) -> dict[str, int | None]:
    """Return the digital channels of an encoder; None where they are not known."""
    is_made = named("EncoderSim.createForIndex")(index).getInitialized()
    a, b = (channels_of(index) if is_made else None) or (None, None)
    return {"ASource_Channel": a, "BSource_Channel": b}


F = DeviceField  # a short name, for a compact table

_CONTROL = DeviceKind(
    "control",
    (shared.ENABLED, Input("autonomous", "Autonomous", BOOL), Input("test", "Test", BOOL), *shared.ATTACHED),
    shared.station_sim,
    exists="",
    stays=True,
)
_POWER = DeviceKind(
    "power",
    (
        shared.battery("VInVoltage"),
        Measured("vin_current", "VInCurrent", FLOAT, quantity="amperes", asked_by="InputCurrent"),
        F("brownout_voltage", "BrownoutVoltage", FLOAT),
        *chain.from_iterable(map(shared.rail, ("6V", "5V", "3V3"))),
        HAS_SOURCE,
    ),
    shared.controller_sim,
    exists="",
    seldom=True,
    panel="Power",
)
_ROBORIO = DeviceKind(
    "roborio",
    (
        F("team_number", "TeamNumber", INT32, recorded=False),
        F("serial_number", "SerialNumber", text(8), recorded=False, asked_by="SerialNumber", stays=True),
        F("comments", "Comments", text(64), recorded=False, asked_by="Comments", stays=True),
        Measured("cpu_temp", "CPUTemp", FLOAT, recorded=False, quantity="celsius", asked_by="CPUTemp"),
        F("radio_led_state", "RadioLEDState", LED_STATE),
    ),
    shared.controller_sim,
    exists="",
)
_BUTTON = DeviceKind(
    "",
    (
        Measured(
            "fpga_button",
            "FPGAButton",
            BOOL,
            quantity="switch",
            shown=Shown("switch", "User button", "The button on the roboRIO"),
        ),
    ),
    shared.controller_sim,
    exists="",
    seldom=True,
    panel=CURRENT.controller.name,
)
_ACCELEROMETER = DeviceKind(
    "accelerometer",
    (
        F("active", "Active", BOOL),
        F("range", "Range", RANGE),
        *(
            Measured(
                axis,
                axis.upper(),
                FLOAT,
                quantity="acceleration",
                shown=Shown(
                    "slider",
                    f"Accelerometer {axis}",
                    f"The accelerometer in the roboRIO, along {axis}",
                    -8.0,
                    8.0,
                    2,
                    "g",
                ),
            )
            for axis in "xyz"
        ),
        HAS_SOURCE,
    ),
    later("BuiltInAccelerometerSim"),
    exists="active",
    panel=CURRENT.controller.name,
)

#: All devices, in the order in which recordings and traces have them.
KINDS: tuple[DeviceKind, ...] = (
    _CONTROL,
    _POWER,
    _ROBORIO,
    shared.TIME,
    shared.ALLIANCE,
    _BUTTON,
    shared.PROGRAM,
    _ACCELEROMETER,
    DeviceKind(
        "pwm",
        (
            INITIALIZED,
            F("type"),
            F("raw_value", "PulseMicrosecond", INT32, unset=0, off=shared.NEUTRAL_US),
            shared.motor("Speed"),
            F("position", "Position", number(0, 1), recorded=False, unset=NOT_SET),
            F("period_scale", "PeriodScale", INT32),
            F("zero_latch", "ZeroLatch", BOOL),
            F("elim_deadband", default=False),
        ),
        later("PWMSim"),
        20,
        is_on=_drives_motor,
        title="PWM",
        panel="PWM",
        labels="pwm",
    ),
    DeviceKind(
        "dio",
        (
            INITIALIZED,
            HAS_SOURCE,
            shared.DIGITAL,
            F("is_input", "IsInput", BOOL),
            F("pulse_length", "PulseLength", FLOAT),
            F("filter_idx", "FilterIndex", INT32),
        ),
        later("DigitalSim", f"{__package__}.digital"),
        26,
        title="DIO",
        panel="Digital I/O",
        labels="dio",
    ),
    DeviceKind(
        "encoder",
        (
            INITIALIZED,
            HAS_SOURCE,
            *shared.COUNT,
            Measured("period", "Period", FLOAT, stopped="rate"),
            F("direction", "Direction", BOOL),
            F("max_period", "MaxPeriod", FLOAT),
            F("reverse_direction", "ReverseDirection", BOOL),
            F("samples_to_average", "SamplesToAverage", INT32),
            F("distance_per_pulse", "DistancePerPulse", FLOAT, default=1.0),
            # WPILib derives both from period, count and distance per pulse, and vice versa.
            Measured("rate", "Rate", FLOAT, recorded=False, quantity="rate"),
            F("distance", "Distance", FLOAT, recorded=False),
            F("min_rate", default=0.0),
        ),
        later("EncoderSim.createForIndex"),
        8,
        config=encoder_channels,
        wired_to="dio",
        title="Encoder",
        panel="Encoders and counters",
    ),
    DeviceKind(
        "analog_in",
        (
            INITIALIZED,
            HAS_SOURCE,
            *shared.ANALOG,
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
        later("AnalogInputSim"),
        8,
        title="Analog input",
        panel="Analog inputs",
        labels="analog",
    ),
    DeviceKind(
        "analog_out",
        (
            INITIALIZED,
            Output(
                "voltage",
                "Voltage",
                FLOAT,
                unset=NOT_SET,
                shown=Shown("meter", "{}", "{}: the voltage that the robot puts out", 0.0, 5.0, 2, "V"),
            ),
        ),
        later("AnalogOutputSim"),
        8,
        real=2,
        title="Analog output",
        panel="Analog outputs",
    ),
    DeviceKind(
        "analog_gyro",
        (
            INITIALIZED,
            Measured(
                "angle",
                "Angle",
                FLOAT,
                quantity="angle",
                heading=1.0,
                shown=Shown(
                    "slider", "Analog {}", "The gyro at analog input {}: degrees clockwise", -360.0, 360.0, 1, "°"
                ),
            ),
            Measured("rate", "Rate", FLOAT, quantity="turning", turning=1.0),
            F("deadband", default=0.0),
            F("volts_per_degree", default=0.0),
            F("offset", default=0.0),
            F("center", default=0),
        ),
        later("AnalogGyroSim"),
        2,
        wired_to="analog_in",
        panel="Gyros",
    ),
    DeviceKind(
        "analog_trigger",
        (
            INITIALIZED,
            F("trig_lower", "TriggerLowerBound", FLOAT),
            F("trig_upper", "TriggerUpperBound", FLOAT),
            F("port", default=0),
            F("trig_type"),
            F("trig_state", default=False),
        ),
        later("AnalogTriggerSim.createForIndex"),
        8,
    ),
    DeviceKind(
        "relay",
        (
            F("initialized", "InitializedForward", BOOL, recorded=False, get=_relay_initialized, put=_initialize_relay),
            Output(
                "fwd",
                "Forward",
                BOOL,
                unset=False,
                off=False,
                shown=Shown("relay", "{}", "{}: its two directions", also=("rev",)),
            ),
            Output("rev", "Reverse", BOOL, unset=False, off=False),
        ),
        later("RelaySim"),
        4,
        title="Relay",
        panel="Relays",
        labels="relay",
    ),
    DeviceKind("d0_pwm", shared.PWM_ON_DIO, later("DigitalPWMSim.createForIndex"), 26, real=6, panel="PWM"),
    DeviceKind("duty_cycle", shared.DUTY_CYCLE, later("DutyCycleSim.createForIndex"), 8, panel="Digital I/O"),
    DeviceKind(
        "addressable_led",
        (
            INITIALIZED,
            F("output_port", "OutputPort", INT32),
            F("length", "Length", whole(0, 5460)),
            F("running", "Running", BOOL, get=lambda strip: bool(strip.getRunning())),
            shared.LED_DATA,
        ),
        later("AddressableLEDSim.createForIndex"),
        1,
        panel=CURRENT.controller.name,
    ),
    DeviceKind("mxp", (F("initialized", default=False),), count=16),
    DeviceKind("filter", (F("enabled", default=False), F("period", default=0)), count=3),
    DeviceKind(
        "counter",
        (
            INITIALIZED,
            HAS_SOURCE,
            Measured(
                "count",
                "Count",
                INT32,
                shown=Shown("number", "Counter {}", "{}: its counts. Click the number to change it", decimals=0),
            ),
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
        later("CounterSim", f"{__package__}.counters"),
        COUNTERS,
        title="Counter",
        panel="Encoders and counters",
    ),
    *shared.DRIVER_STATION,
    *shared.MODULES,
)
