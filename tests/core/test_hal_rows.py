"""What `hal_data` says of a value by its path, or by the names that vendors give it."""

from __future__ import annotations

from loops import for_each

from pyfrc_core.hal import rows
from pyfrc_core.hal.sim_quantities import quantity_of


@for_each(
    "path, role, stays, made_by_robot",
    [
        ("pwm[3].value", "output", False, False),
        ("dio[0].value", "measured", False, False),
        ("control.enabled", "input", True, False),
        ("event.name", "", True, False),
        ("joysticks[0].axes[1]", "input", False, False),
        ("pcm[0][1].value", "output", False, True),
        ("pdp[1].current[0]", "measured", False, True),
        ("custom.x", "", False, True),
        ('CAN["SPARK MAX [3]"].Position', "measured", False, True),
        ('CAN["SPARK MAX [3]"]["Position Conversion Factor"]', "", False, True),
        ('CAN["SPARK MAX [3]"]["Applied Output"]', "output", False, True),
        ('CAN["SPARK MAX [3]"].Unknown', "", False, True),
    ],
)
def test_what_a_value_is_by_its_path(path: str, role: str, stays: bool, made_by_robot: bool) -> None:
    assert (rows.role_of(path), rows.stays(path), rows.made_by_robot(path)) == (role, stays, made_by_robot)


def test_what_is_no_path_has_no_row() -> None:
    assert (rows.row_of("pwm["), rows.kind_of("pwm["), rows.role_of("pwm["), rows.stays("pwm[")) == (
        None,
        None,
        "",
        False,
    )


def test_a_digital_channel_is_an_input_unless_it_says_otherwise() -> None:
    assert rows.decides("dio[4].is_input")
    assert not rows.decides("dio[4].value")
    asked = {"dio[4].is_input": False, "dio[5].is_input": True}
    assert [rows.is_input(f"dio[{number}].value", asked) for number in (4, 5, 6)] == [False, True, True]
    assert rows.is_input("custom.x", asked)


def test_which_gyros_turn_with_the_robot() -> None:
    found = [(row.kind.name, row.field.name) for row in rows.gyros(numbered=True)]
    assert found == [("analog_gyro", "angle"), ("analog_gyro", "rate")]
    assert rows.gyros(numbered=False) == ()


@for_each(
    "device, value, sort, quantity",
    [
        ("SPARK MAX [3]", "Position", "number", "rotations"),
        ("SPARK MAX [3] ABSOLUTE ENCODER", "Position", "number", "turns"),
        ("SPARK MAX [3] ANALOG SENSOR", "Voltage", "number", "volts"),
        ("SPARK FLEX [3]", "Velocity", "number", "rpm"),
        ("CANEncoder:CANcoder (v6)[1]", "rawPositionInput", "number", "rotations"),
        ("CANGyro:Pigeon 2 (v6)[1]", "rawYawInput", "number", "angle"),
        ("CANGyro:Pigeon 2 (v6)[1]", "angularVelocityZ", "number", "turning"),
        ("navX-Sensor[4]", "Yaw", "number", "half turns"),
        ("navX-Sensor[4]", "CompassHeading", "number", "heading"),
        ("Gyro:ADXRS450[0]", "angle_x", "number", "angle"),
        ("Gyro:ADXRS450[0]", "rate_x", "number", "turning"),
        ("Accel:ADXL345[1]", "x", "number", "acceleration"),
        ("Ultrasonic[0]", "Range (in)", "number", "range"),
        ("Talon", "supplyVoltage", "number", "battery"),
        ("Talon", "torqueCurrent", "number", "amperes"),
        ("DutyCycle[0]", "output", "number", "turns"),
        ("navX-Sensor[4]", "Connected", "boolean", "connected"),
        ("Ultrasonic[0]", "Range Valid", "boolean", "connected"),
        ("Lidar", "pressed", "boolean", "switch"),
        ("Accel:ADXL345[1]", "Range", "option", "option"),
        ("SPARK MAX [3]", "Motor Temperature", "whole", "celsius"),
        ("SPARK MAX [3]", "Faults", "long", "whole"),
    ],
)
def test_the_quantity_of_what_a_vendor_simulates(device: str, value: str, sort: str, quantity: str) -> None:
    assert quantity_of(device, value, sort) == quantity
