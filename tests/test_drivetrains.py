"""The simple drivetrains: both generations of callers, with WPILib's own kinematics as the reference."""

from __future__ import annotations

import inspect
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each
from wpimath.geometry import Rotation2d, Translation2d
from wpimath.kinematics import (
    ChassisSpeeds,
    DifferentialDriveKinematics,
    MecanumDriveKinematics,
    SwerveDrive4Kinematics,
    SwerveModuleState,
)

from pyfrc.physics import drivetrains
from pyfrc.physics.drivetrains import (
    DriveVector,
    FourMotorDrivetrain,
    MecanumDrivetrain,
    TwoMotorDrivetrain,
    four_motor_serve_drivetrain,
    four_motor_swerve_drivetrain,
    linear_deadzone,
)

METRES = 0.3048

motors = st.floats(-1, 1)
lengths = st.floats(0.1, 10)
speeds = st.floats(0.1, 30)
degrees = st.floats(-720, 720)


def close(a: Any, b: Any) -> bool:
    return bool(tuple(a) == pytest.approx(tuple(b), abs=1e-9, rel=1e-9))


def axes(chassis: ChassisSpeeds) -> tuple[float, float, float]:
    return chassis.vx, chassis.vy, chassis.omega


def as_metres(vector: DriveVector) -> tuple[float, float, float]:
    """(right, forward, clockwise) in feet as (forward, left, counter-clockwise) in metres."""
    right, forward, clockwise = vector
    return forward * METRES, -right * METRES, -clockwise


# -- as documented -----------------------------------------------------------------------------------------------


@for_each(
    "name, defaults",
    [
        ("TwoMotorDrivetrain", {"x_wheelbase": 2, "speed": 5, "deadzone": None}),
        ("FourMotorDrivetrain", {"x_wheelbase": 2, "speed": 5, "deadzone": None}),
        ("MecanumDrivetrain", {"x_wheelbase": 2, "y_wheelbase": 3, "speed": 5, "deadzone": None}),
    ],
)
def test_the_constructors_have_the_documented_parameters(name: str, defaults: dict[str, Any]) -> None:
    signature = inspect.signature(getattr(drivetrains, name))
    assert {parameter.name: parameter.default for parameter in signature.parameters.values()} == defaults


def test_tank_drives_go_forward_with_the_left_motors_at_minus_one() -> None:
    two, four = TwoMotorDrivetrain(), FourMotorDrivetrain()
    assert two.get_vector(-1, 1) == (5.0, 0.0)
    assert (two.l_speed, two.r_speed) == (5.0, 5.0)
    assert four.get_vector(lr_motor=-1, rr_motor=1, lf_motor=-1, rf_motor=1) == (5.0, 0.0)
    assert (four.l_speed, four.r_speed) == (5.0, 5.0)


def test_tank_drives_turn_clockwise_with_the_left_side_ahead() -> None:
    two, four = TwoMotorDrivetrain(x_wheelbase=2, speed=5), FourMotorDrivetrain(x_wheelbase=2, speed=5)
    assert two.get_vector(-1, -1) == (0.0, 5.0)
    assert (two.l_speed, two.r_speed) == (5.0, -5.0)
    assert four.get_vector(-1, -1, -1, -1) == (0.0, 5.0)


def test_the_motors_of_a_chained_side_share_the_work() -> None:
    drivetrain = FourMotorDrivetrain()
    drivetrain.get_vector(lr_motor=-1, rr_motor=0.5, lf_motor=0, rf_motor=0.1)
    assert drivetrain.l_speed == 2.5
    assert drivetrain.r_speed == pytest.approx(1.5)


@for_each(
    "lr, rr, lf, rf, vector",
    [
        (1, 1, 1, 1, (0, 5, 0)),
        (-1, 1, 1, -1, (5, 0, 0)),
        (1, -1, 1, -1, (0, 0, 2)),
        (1, 1, -1, -1, (0, 0, 0)),
        (0, 0, 1, 0, (1.25, 1.25, 0.5)),
    ],
)
def test_mecanum_wheels_go_forward_strafe_and_turn_as_documented(
    lr: float, rr: float, lf: float, rf: float, vector: tuple[float, ...]
) -> None:
    drivetrain = MecanumDrivetrain()
    assert drivetrain.get_vector(lr_motor=lr, rr_motor=rr, lf_motor=lf, rf_motor=rf) == pytest.approx(vector)
    wheels = drivetrain.lr_speed, drivetrain.rr_speed, drivetrain.lf_speed, drivetrain.rf_speed
    assert wheels == (lr * 5, rr * 5, lf * 5, rf * 5)


def test_the_misprint_of_the_documentation_is_the_same_function() -> None:
    assert four_motor_serve_drivetrain is four_motor_swerve_drivetrain
    parameters = list(inspect.signature(four_motor_serve_drivetrain).parameters)
    wheels = ["lr", "rr", "lf", "rf"]
    motors_and_angles = [f"{wheel}_motor" for wheel in wheels] + [f"{wheel}_angle" for wheel in wheels]
    assert parameters == [*motors_and_angles, "x_wheelbase", "y_wheelbase", "speed", "deadzone"]


@for_each(
    "angles, vector",
    [
        ((0, 0, 0, 0), (0, 5, 0)),
        ((90, 90, 90, 90), (5, 0, 0)),
        ((180, 180, 180, 180), (0, -5, 0)),
        # On the circle of radius sqrt(2) ft around the centre: 5 / sqrt(2).
        ((315, 225, 45, 135), (0, 0, 5 / math.sqrt(2))),
    ],
)
def test_swerve_angles_are_clockwise_from_forward(angles: Any, vector: Any) -> None:
    answer = four_motor_swerve_drivetrain(1, 1, 1, 1, *angles)
    assert close(answer, vector)
    assert close((answer.vx_fps, answer.vy_fps, answer.omega), (vector[0], vector[1], -vector[2]))


def test_the_deprecated_functions_work_and_name_the_users_line() -> None:
    with pytest.warns(DeprecationWarning, match="TwoMotorDrivetrain") as warned:
        assert drivetrains.two_motor_drivetrain(-1, -1, x_wheelbase=4, speed=6) == (0.0, 3.0)
    assert warned[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="FourMotorDrivetrain") as warned:
        assert drivetrains.four_motor_drivetrain(-1, 1, -1, 1, speed=6, deadzone=linear_deadzone(0.1)) == (6.0, 0.0)
    assert warned[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="MecanumDrivetrain") as warned:
        assert drivetrains.mecanum_drivetrain(-1, 1, 1, -1, speed=6) == (6.0, 0.0, 0.0)
    assert warned[0].filename == __file__


# -- as called today ---------------------------------------------------------------------------------------------


def test_calculate_has_the_left_forward_at_one_and_answers_metres() -> None:
    two, four, mecanum = TwoMotorDrivetrain(), FourMotorDrivetrain(), MecanumDrivetrain()
    assert axes(two.calculate(1, -1)) == pytest.approx((1.524, 0, 0))
    assert axes(two.calculate(1, 1)) == pytest.approx((0, 0, -5))
    assert (two.wheelSpeeds.left, two.wheelSpeeds.right) == pytest.approx((1.524, -1.524))
    assert axes(four.calculate(lf_motor=1, lr_motor=1, rf_motor=-1, rr_motor=-1)) == pytest.approx((1.524, 0, 0))
    assert axes(four.calculate(1, 0, 0, 0)) == pytest.approx((0.381, 0, -1.25))
    assert axes(mecanum.calculate(lf_motor=1, lr_motor=1, rf_motor=-1, rr_motor=-1)) == pytest.approx((1.524, 0, 0))
    assert axes(mecanum.calculate(1, -1, 1, -1)) == pytest.approx((0, -1.524, 0))
    assert axes(mecanum.calculate(1, 1, 1, 1)) == pytest.approx((0, 0, -2))
    wheels = mecanum.wheelSpeeds
    assert (wheels.frontLeft, wheels.frontRight) == pytest.approx((1.524, -1.524))
    assert (wheels.rearLeft, wheels.rearRight) == pytest.approx((1.524, -1.524))


def test_measures_may_be_quantities() -> None:
    from pyfrc.physics.units import units

    two = TwoMotorDrivetrain(x_wheelbase=24 * units.inch, speed=1.524 * units.meter / units.second)
    assert two.get_vector(-1, -1) == pytest.approx((0.0, 5.0))
    mecanum = MecanumDrivetrain(1 * units.meter, 0.5 * units.meter, 2 * units.meter / units.second)
    assert axes(mecanum.calculate(1, 1, 1, 1)) == pytest.approx((0, 0, -2 / 0.75))
    swerve = four_motor_swerve_drivetrain(1, 1, 1, 1, 0, 0, 0, 0, speed=1 * units.meter / units.second)
    assert swerve.vy_fps == pytest.approx(1 / METRES)


# -- against WPILib's kinematics ---------------------------------------------------------------------------------


@given(left=motors, right=motors, width=lengths, speed=speeds)
def test_tank_agrees_with_wpilib_and_with_itself(left: float, right: float, width: float, speed: float) -> None:
    two, four = TwoMotorDrivetrain(width, speed), FourMotorDrivetrain(width, speed)
    chassis = two.calculate(left, -right)
    reference = DifferentialDriveKinematics(width * METRES)
    assert close(axes(reference.toChassisSpeeds(two.wheelSpeeds)), axes(chassis))
    wheels = reference.toWheelSpeeds(chassis)
    assert close((wheels.left, wheels.right), (left * speed * METRES, right * speed * METRES))
    assert close(axes(two.kinematics.toChassisSpeeds(two.wheelSpeeds)), axes(chassis))

    forward, clockwise = two.get_vector(-left, right)
    assert close((forward * METRES, 0, -clockwise), axes(chassis))
    assert close(four.get_vector(-left, right, -left, right), (forward, clockwise))
    assert close(axes(four.calculate(left, left, -right, -right)), axes(chassis))


@given(lf=motors, lr=motors, rf=motors, rr=motors, x=lengths, y=lengths, speed=speeds)
def test_mecanum_agrees_with_wpilib_and_with_itself(
    lf: float, lr: float, rf: float, rr: float, x: float, y: float, speed: float
) -> None:
    drivetrain = MecanumDrivetrain(x, y, speed)
    chassis = drivetrain.calculate(lf, lr, -rf, -rr)
    half_x, half_y = x / 2 * METRES, y / 2 * METRES
    reference = MecanumDriveKinematics(
        Translation2d(half_y, half_x),
        Translation2d(half_y, -half_x),
        Translation2d(-half_y, half_x),
        Translation2d(-half_y, -half_x),
    )
    for kinematics in (reference, drivetrain.kinematics):
        assert close(axes(kinematics.toChassisSpeeds(drivetrain.wheelSpeeds)), axes(chassis))
    assert close(as_metres(drivetrain.get_vector(lr, rr, lf, rf)), axes(chassis))


def swerve_reference(x: float, y: float) -> SwerveDrive4Kinematics:
    """In the order of our parameters: left rear, right rear, left front, right front."""
    half_x, half_y = x / 2 * METRES, y / 2 * METRES
    return SwerveDrive4Kinematics(
        Translation2d(-half_y, half_x),
        Translation2d(-half_y, -half_x),
        Translation2d(half_y, half_x),
        Translation2d(half_y, -half_x),
    )


@given(
    motor=st.tuples(motors, motors, motors, motors),
    angle=st.tuples(degrees, degrees, degrees, degrees),
    x=lengths,
    y=lengths,
    speed=speeds,
)
def test_swerve_agrees_with_wpilib(motor: Any, angle: Any, x: float, y: float, speed: float) -> None:
    arguments: Any = (*motor, *angle, x, y, speed)
    answer = four_motor_swerve_drivetrain(*arguments)
    states = tuple(
        SwerveModuleState(value * speed * METRES, Rotation2d(-math.radians(clockwise)))
        for value, clockwise in zip(motor, angle, strict=True)
    )
    assert close(axes(swerve_reference(x, y).toChassisSpeeds(states)), as_metres(answer))  # type: ignore[arg-type]


# -- deadzones and motor values ----------------------------------------------------------------------------------


def test_the_documented_deadzone() -> None:
    deadzone = linear_deadzone(0.2)
    assert [deadzone(motor) for motor in (0.0, 0.2, 0.3, 1.0)] == pytest.approx([0.0, 0.0, 0.125, 1.0])


@given(deadzone=st.floats(0, 0.99), motor=motors, other=motors)
def test_a_deadzone_is_odd_continuous_and_never_more_than_its_input(
    deadzone: float, motor: float, other: float
) -> None:
    output = linear_deadzone(deadzone)
    assert output(-motor) == -output(motor)
    assert abs(output(motor)) <= abs(motor) + 1e-12
    assert abs(output(motor) - output(other)) <= abs(motor - other) / (1 - deadzone) + 1e-12
    assert output(1) == pytest.approx(1)
    assert (output(motor) == 0) == (abs(motor) <= deadzone)


def test_a_deadzone_that_cannot_be_is_an_error() -> None:
    for wrong in (-0.1, 1, 1.5, math.nan, math.inf, "0.2", None):
        with pytest.raises(ValueError, match=r"^deadzone = "):
            linear_deadzone(wrong)  # type: ignore[arg-type]


@given(value=st.floats(min_value=1.0, allow_infinity=True))
def test_no_motor_gives_more_than_full_power(value: float) -> None:
    assert linear_deadzone(0.2)(value) == pytest.approx(1.0)
    assert linear_deadzone(0.2)(-value) == pytest.approx(-1.0)
    assert TwoMotorDrivetrain().get_vector(-value, value) == (5.0, 0.0)
    assert FourMotorDrivetrain().get_vector(-value, value, -value, value) == (5.0, 0.0)
    assert MecanumDrivetrain().get_vector(value, value, value, value) == (0.0, 5.0, 0.0)
    assert four_motor_swerve_drivetrain(value, value, value, value, 0, 0, 0, 0) == (0.0, 5.0, 0.0)


def test_a_motor_value_that_is_not_a_number_is_named() -> None:
    nan = math.nan
    for drivetrain in (TwoMotorDrivetrain(), FourMotorDrivetrain(), MecanumDrivetrain(deadzone=linear_deadzone(0.1))):
        for function in (drivetrain.get_vector, drivetrain.calculate):
            names = list(inspect.signature(function).parameters)
            for name in names:
                with pytest.raises(ValueError, match=rf"^{name} is not a number"):
                    function(**{**dict.fromkeys(names, 0), name: nan})
    with pytest.raises(ValueError, match=r"^motor_input is not a number"):
        linear_deadzone(0.2)(nan)
    with pytest.raises(ValueError, match=r"^rf_angle = nan"):
        four_motor_swerve_drivetrain(1, 1, 1, 1, 0, 0, 0, nan)


def test_deadzones_apply_to_each_motor_and_may_be_changed() -> None:
    asked: list[float] = []

    def half(motor: float) -> float:
        asked.append(motor)
        return motor / 2

    for drivetrain, motor in (
        (TwoMotorDrivetrain(deadzone=half), [-0.2, 0.4]),
        (FourMotorDrivetrain(deadzone=half), [-0.2, 0.4, -0.6, 0.8]),
        (MecanumDrivetrain(deadzone=half), [-0.2, 0.4, -0.6, 0.8]),
    ):
        asked.clear()
        slow = drivetrain.get_vector(*motor)
        assert sorted(asked) == sorted(motor)
        drivetrain.deadzone = None
        assert close(drivetrain.get_vector(*motor), [2 * axis for axis in slow])
    assert four_motor_swerve_drivetrain(1, 1, 1, 1, 0, 0, 0, 0, deadzone=half).vy_fps == 2.5


@for_each(
    "name, parameter",
    [
        ("TwoMotorDrivetrain", "x_wheelbase"),
        ("TwoMotorDrivetrain", "speed"),
        ("FourMotorDrivetrain", "x_wheelbase"),
        ("MecanumDrivetrain", "x_wheelbase"),
        ("MecanumDrivetrain", "y_wheelbase"),
        ("MecanumDrivetrain", "speed"),
    ],
)
def test_measures_that_cannot_be_are_named(name: str, parameter: str) -> None:
    for wrong in (0, -2, math.nan, math.inf, "two", None, [2]):
        with pytest.raises(ValueError, match=rf"\b{parameter}\b"):
            getattr(drivetrains, name)(**{parameter: wrong})


def test_a_number_for_a_deadzone_is_answered_with_the_function_to_use() -> None:
    with pytest.raises(ValueError, match=r"(?s)deadzone = 0.2: must be a function.*linear_deadzone"):
        TwoMotorDrivetrain(deadzone=0.2)  # type: ignore[arg-type]
