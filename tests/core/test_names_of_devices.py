"""Names of a robot's devices, from which `pyfrc create-physics` concludes what they drive."""

from __future__ import annotations

from pyfrc_core.physics.create.motors import Motor
from pyfrc_core.physics.create.names import DeviceName, one_line


def name(text: str) -> DeviceName:
    return DeviceName(tuple(text.split(".")))


def test_sides_ends_and_tasks() -> None:
    sides = {
        "left_motor": "left",
        "drive.frontRightTalon": "right",
        "left.right_motor": "right",
        "l1": "left",
        "arm": None,
    }
    assert {each: name(each).side for each in sides} == sides
    ends = {"front_left": "front", "rear.motor": "rear", "rl": "rear", "left_motor": None, "front_rear": None}
    assert {each: name(each).end for each in ends} == ends
    tasks = {"swerve.steer_motor": "steer", "driveMotor": "drive", "drive.azimuth": "steer", "lift_motor": None}
    assert {each: name(each).task for each in tasks} == tasks
    assert [name(each).says_swerve for each in ("swerve.a", "azimuth_a", "drive.a")] == [True, True, False]


def test_what_contradicts_a_drivetrain() -> None:
    plain = {"left_motor": True, "drivetrain.l1": True, "left_climber": False, "left_x_motor": True, "lift.left": False}
    assert {each: name(each).is_plain for each in plain} == plain
    assert (DeviceName().is_plain, bool(DeviceName()), bool(name("a")), name("a.b").owner) == (
        False,
        False,
        True,
        ("a",),
    )
    assert name("_Arm__lift2Motor").purpose == {"lift"}


def test_devices_are_shown_in_one_line() -> None:
    assert one_line("a\nb\t\x1b[1m  c") == "a b [1m c"
    assert str(DeviceName(("motors", "[0]", "left\n"))) == "motors[0].left"
    motors = {
        "PWM 3 (left)": Motor(name("left"), 3),
        "PWM 0": Motor(DeviceName(), 0),
        "SPARK MAX [7] (arm)": Motor(name("arm"), None, "SPARK\nMAX [7]"),
    }
    assert {str(each): each for each in motors.values()} == motors
    assert [each.path for each in motors.values()] == ["pwm[3]", "pwm[0]", "CAN[SPARK\nMAX [7]]"]
