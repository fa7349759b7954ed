"""The devices of SystemCore: a table that says what each value is, and how WPILib's simulation has it (see `fields`).

What 2026's table has and SystemCore lacks is absent: analog outputs, gyros and triggers, relays, counters, filters, the
accelerometer, the rails of 5 and 6 volts. It imports WPILib only when a device is made.
"""

from __future__ import annotations

from functools import partial
from math import pi

from ...season import CURRENT
from ...wpi.encoder_channels import channels_of
from .. import shared_rows as shared
from ..fields import HAS_SOURCE, INITIALIZED, DeviceField, DeviceKind, Input, Measured, Quantity, Shown, later, named
from ..kinds import BOOL, FLOAT, INT32, text, whole

#: The ports of SystemCore at which a channel can be anything.
_SMART_IO = 6


def encoder_channels(index: int) -> dict[str, int | None]:
    """Return the digital channels of an encoder; None where they are not known."""
    is_made = named("EncoderSim.create_for_index")(index).get_initialized()
    a, b = (channels_of(index) if is_made else None) or (None, None)
    return {"ASource_Channel": a, "BSource_Channel": b}


F = DeviceField  # short names, for a compact table
_of_station = partial(later, module=f"{__package__}.driver_station")


_CONTROL = DeviceKind(
    "control",
    (
        shared.ENABLED,
        # Three flags in 2026; each is shown from the one mode.
        *(
            Input(name, "robot_mode", BOOL, get=_of_station(f"is_{name}"), put=_of_station(f"set_{name}"))
            for name in ("autonomous", "test")
        ),
        Input("opmode", "opmode", text(255), get=_of_station("opmode_name"), put=_of_station("select_opmode")),
        *shared.ATTACHED,
    ),
    shared.station_sim,
    exists="",
    stays=True,
)
_POWER = DeviceKind(
    "power",
    (
        shared.battery("vin_voltage"),
        F("brownout_voltage", "brownout_voltage", FLOAT),
        F("brownout_recovery_voltage", "brownout_recovery_voltage", FLOAT, recorded=False),
        *shared.rail("_3v3"),
        HAS_SOURCE,
    ),
    shared.controller_sim,
    exists="",
    seldom=True,
    panel="Power",
)
#: The controller's own values, under the key that they had when it was a roboRIO.
_SYSTEMCORE = DeviceKind(
    "roborio",
    (
        F("team_number", "team_number", INT32, recorded=False),
        F("serial_number", "serial_number", text(8), recorded=False, asked_by="serial_number", stays=True),
        F("comments", "comments", text(64), recorded=False, asked_by="comments", stays=True),
        Measured("cpu_temp", "cpu_temp", FLOAT, recorded=False, quantity="celsius", asked_by="cpu_temp"),
    ),
    shared.controller_sim,
    exists="",
)


def _of_imu(name: str, quantity: Quantity, unit: str, heading: float = 0.0, turning: float = 0.0) -> DeviceField:
    shown = Shown("number", name.replace("_", " ").capitalize(), "The IMU in SystemCore", unit=unit)
    return Measured(name, name, FLOAT, quantity=quantity, heading=heading, turning=turning, shown=shown)


#: A degree clockwise: WPILib's yaw is counter-clockwise, in radians.
_CLOCKWISE = -pi / 180
_IMU = DeviceKind(
    "onboard_imu",
    (
        F("active", "active", BOOL),
        _of_imu("yaw", "radians", "rad", heading=_CLOCKWISE),
        *(_of_imu(f"angle_{axis}", "radians", "rad", heading=_CLOCKWISE * (axis == "z")) for axis in "xyz"),
        *(
            _of_imu(f"gyro_rate_{axis}", "radians per second", "rad/s", turning=_CLOCKWISE * (axis == "z"))
            for axis in "xyz"
        ),
        *(_of_imu(f"accel_{axis}", "m/s2", "m/s²") for axis in "xyz"),
    ),
    later("ImuSim", f"{__package__}.onboard_imu"),
    exists="active",
    panel="Gyros",
)

#: All devices, in the order in which recordings and traces have them.
KINDS: tuple[DeviceKind, ...] = (
    _CONTROL,
    _POWER,
    _SYSTEMCORE,
    shared.TIME,
    shared.ALLIANCE,
    shared.PROGRAM,
    _IMU,
    DeviceKind(
        "pwm",
        (
            INITIALIZED,
            F("raw_value", "pulse_microsecond", INT32, unset=0, off=shared.NEUTRAL_US),
            shared.motor("throttle"),
            F("output_period", "output_period", INT32),
        ),
        later("MotorPwmSim", f"{__package__}.pwm"),
        20,
        is_on=lambda pwm: bool(pwm["value"]),  # other outputs than motors', such as servos', keep their pulse
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
            F("is_input", "is_input", BOOL),
            F("pulse_length", "pulse_length", FLOAT),
        ),
        later("DigitalSim", f"{__package__}.digital"),
        31,
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
            F("direction", "direction", BOOL),
            F("reverse_direction", "reverse_direction", BOOL),
            F("distance_per_pulse", "distance_per_pulse", FLOAT, default=1.0),
            Measured("rate", "rate", FLOAT, quantity="rate"),
            F("distance", "distance", FLOAT, recorded=False),
        ),
        later("EncoderSim.create_for_index"),
        8,
        config=encoder_channels,
        wired_to="dio",
        title="Encoder",
        panel="Encoders and counters",
    ),
    DeviceKind(
        "analog_in",
        (INITIALIZED, HAS_SOURCE, *shared.ANALOG),
        later("AnalogInputSim"),
        8,
        title="Analog input",
        panel="Analog inputs",
        labels="analog",
    ),
    DeviceKind("d0_pwm", shared.PWM_ON_DIO, later("DigitalPWMSim.create_for_index"), _SMART_IO, panel="PWM"),
    DeviceKind(
        "duty_cycle", shared.DUTY_CYCLE, later("DutyCycleSim.create_for_channel"), _SMART_IO, panel="Digital I/O"
    ),
    DeviceKind(
        "addressable_led",
        (INITIALIZED, F("start", "start", INT32), F("length", "length", whole(0, 1024)), shared.LED_DATA),
        later("AddressableLEDSim"),
        _SMART_IO,
        panel=CURRENT.controller.name,
    ),
    *shared.DRIVER_STATION,
    *shared.MODULES,
)
