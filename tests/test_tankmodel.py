"""The tank drive: exact within a step of any length, and what a physical drivetrain can never do."""

from __future__ import annotations

import logging
import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loops import for_each
from wpimath.geometry import Transform2d

from pyfrc.physics.motor_cfgs import MOTOR_CFG_CIM, MOTOR_CFG_NEO
from pyfrc.physics.tankmodel import MotorModel, TankModel
from pyfrc.physics.units import units
from pyfrc_core.physics.parameters import ParameterError
from pyfrc_core.physics.quantities import WrongDimension

MASS, WHEELBASE, WIDTH, LENGTH = 90 * units.lbs, 2.0 * units.feet, 27.5 * units.inch, 36.5 * units.inch

motor_values = st.floats(-1, 1)
steps = st.lists(st.tuples(motor_values, motor_values, st.floats(0.001, 1.0)), min_size=1, max_size=6)


def theory(**others: Any) -> TankModel:
    """The documentation's robot: 90 lb, 2 CIM motors a side, 6 inch wheels."""
    parameters: dict[str, Any] = {"robot_mass": MASS, "gearing": 10.71, "nmotors": 2, "x_wheelbase": WHEELBASE}
    return TankModel.theory(MOTOR_CFG_CIM, **{**parameters, **others})


def measured(l_kv: float = 0.9, l_ka: float = 0.2, r_kv: float = 1.0, r_ka: float = 0.3) -> TankModel:
    """A robot whose sides differ, in speed and in time constant."""
    left = l_kv * units.tm_kv, l_ka * units.tm_ka, 1.1 * units.volt
    right = r_kv * units.tm_kv, r_ka * units.tm_ka, 1.4 * units.volt
    return TankModel(MOTOR_CFG_CIM, MASS, WHEELBASE, WIDTH, LENGTH, *left, *right)


class Track:
    """Compose the results of `get_distance`: x forward and y to the right of the first pose, angle clockwise."""

    def __init__(self, model: TankModel) -> None:
        self.model, self.x, self.y, self.angle = model, 0.0, 0.0, 0.0

    def drive(self, l_forward: float, r_forward: float, seconds: float, count: int = 1) -> None:
        for _ in range(count):
            x, y, angle = self.model.get_distance(-l_forward, r_forward, seconds / count)
            cos, sin = math.cos(self.angle), math.sin(self.angle)
            self.x += x * cos - y * sin
            self.y += x * sin + y * cos
            self.angle += angle

    @property
    def state(self) -> tuple[float, ...]:
        model = self.model
        return self.x, self.y, self.angle, model.l_position, model.r_position, model.l_velocity, model.r_velocity


class Reference:
    """The equations as the documentation has them, integrated by the classical Runge-Kutta method."""

    def __init__(self, left: tuple[float, float, float], right: tuple[float, float, float], turning: float) -> None:
        self.sides, self.turning = (left, right), turning
        self.state: tuple[float, ...] = (0.0,) * 7  # x, y, angle, positions, velocities

    def drive(self, l_forward: float, r_forward: float, seconds: float, longest: float = 0.002) -> None:
        (l_kv, l_ka, l_vi), (r_kv, r_ka, r_vi) = self.sides
        l_volts, r_volts = (
            math.copysign(max(abs(12 * power) - vi, 0), power) for power, vi in ((l_forward, l_vi), (r_forward, r_vi))
        )
        turning, sin, cos = self.turning, math.sin, math.cos

        def rates(angle: float, left: float, right: float) -> tuple[float, float, float, float, float]:
            """Return those of x, y, the angle and the velocities; those of the positions are the velocities."""
            speed = (left + right) / 2
            accelerations = (l_volts - l_kv * left) / l_ka, (r_volts - r_kv * right) / r_ka
            return speed * cos(angle), speed * sin(angle), turning * (left - right), *accelerations

        count = math.ceil(seconds / longest)
        h = seconds / count
        half, sixth = h / 2, h / 6
        x, y, angle, l_position, r_position, left, right = self.state
        for _ in range(count):  # written out: this is nearly all that these tests do
            x1, y1, turn1, l_1, r_1 = rates(angle, left, right)
            l_a, r_a = left + l_1 * half, right + r_1 * half
            x2, y2, turn2, l_2, r_2 = rates(angle + turn1 * half, l_a, r_a)
            l_b, r_b = left + l_2 * half, right + r_2 * half
            x3, y3, turn3, l_3, r_3 = rates(angle + turn2 * half, l_b, r_b)
            l_c, r_c = left + l_3 * h, right + r_3 * h
            x4, y4, turn4, l_4, r_4 = rates(angle + turn3 * h, l_c, r_c)
            x += sixth * (x1 + 2 * x2 + 2 * x3 + x4)
            y += sixth * (y1 + 2 * y2 + 2 * y3 + y4)
            angle += sixth * (turn1 + 2 * turn2 + 2 * turn3 + turn4)
            l_position += sixth * (left + 2 * l_a + 2 * l_b + l_c)
            r_position += sixth * (right + 2 * r_a + 2 * r_b + r_c)
            left += sixth * (l_1 + 2 * l_2 + 2 * l_3 + l_4)
            right += sixth * (r_1 + 2 * r_2 + 2 * r_3 + r_4)
        self.state = x, y, angle, l_position, r_position, left, right


def reference_of_measured() -> Reference:
    inertia = 90 * ((27.5 / 12) ** 2 + (36.5 / 12) ** 2) / 12
    return Reference((0.9, 0.2, 1.1), (1.0, 0.3, 1.4), 2.0 / 2 * 90 / inertia)


# -- the pose, exactly -------------------------------------------------------------------------------------------------


@settings(max_examples=30)
@given(steps)
def test_one_step_or_a_hundred_gives_the_same_pose(values: list[tuple[float, float, float]]) -> None:
    one, hundred = Track(measured()), Track(measured())
    for l_forward, r_forward, seconds in values:
        one.drive(l_forward, r_forward, seconds)
        hundred.drive(l_forward, r_forward, seconds, count=100)
    assert one.state == pytest.approx(hundred.state, abs=1e-6)


@settings(max_examples=25)
@given(st.lists(st.tuples(motor_values, motor_values, st.floats(0.001, 0.3)), min_size=1, max_size=4))
def test_pose_agrees_with_a_fine_integration(values: list[tuple[float, float, float]]) -> None:
    track, reference = Track(measured()), reference_of_measured()
    for l_forward, r_forward, seconds in values:
        track.drive(l_forward, r_forward, seconds)
        reference.drive(l_forward, r_forward, seconds)
    assert track.state == pytest.approx(reference.state, abs=1e-6)


# -- what each side does -----------------------------------------------------------------------------------------------


@settings(max_examples=30)
@given(steps)
def test_free_speed_is_never_exceeded(values: list[tuple[float, float, float]]) -> None:
    model = theory()
    free = (12 - 1.3) / (12 / 12.980)
    for left, right, seconds in values:
        model.get_distance(left * 3, right * 3, seconds)  # beyond full power counts as full power
        assert max(abs(model.l_velocity), abs(model.r_velocity)) <= free * 1.0001


@settings(max_examples=30)
@given(st.floats(0.2, 1), st.floats(-1, 0.1), st.floats(0.001, 1))
def test_a_stalled_or_braking_motor_never_gains_speed(before: float, power: float, seconds: float) -> None:
    motor = MotorModel(MOTOR_CFG_CIM, 0.925 * units.tm_kv, 0.22 * units.tm_ka, 1.3 * units.volt)
    motor.compute(power if abs(power) < 0.1 else 0.0, seconds)
    assert motor.velocity == 0.0  # stalled: friction holds it
    moving = motor.compute(before, 0.5)
    assert motor.compute(power, seconds) < moving
    assert motor.acceleration <= 0


@settings(max_examples=30)
@given(steps)
def test_each_side_is_a_motor_model(values: list[tuple[float, float, float]]) -> None:
    model = measured()
    left = MotorModel(MOTOR_CFG_CIM, 0.9 * units.tm_kv, 0.2 * units.tm_ka, 1.1 * units.volt)
    right = MotorModel(MOTOR_CFG_CIM, 1.0 * units.tm_kv, 0.3 * units.tm_ka, 1.4 * units.volt)
    for l_forward, r_forward, seconds in values:
        model.get_distance(-l_forward, r_forward, seconds)
        assert model.l_velocity == pytest.approx(left.compute(l_forward, seconds), abs=1e-12)
        assert model.r_velocity == pytest.approx(right.compute(r_forward, seconds), abs=1e-12)
        assert (model.l_position, model.r_position) == pytest.approx((left.position, right.position), abs=1e-12)


def test_a_motor_model_comes_to_its_steady_speed() -> None:
    motor = MotorModel(MOTOR_CFG_CIM, 0.925 * units.tm_kv, 0.2195 * units.tm_ka, 1.3 * units.volt)
    assert (motor.velocity, motor.acceleration, motor.position) == (0, 0, 0)
    tau, steady = 0.2195 / 0.925, (12 - 1.3) / 0.925
    assert motor.compute(1, tau) == motor.velocity == pytest.approx(steady * (1 - math.exp(-1)))
    assert motor.position == pytest.approx(steady * tau * math.exp(-1))
    assert motor.acceleration == pytest.approx(steady / tau * math.exp(-1))
    assert motor.compute(0.1, 60) == pytest.approx(0)  # 1.2 V do not overcome the friction
    assert motor.compute(-0.5, 60) == pytest.approx(-(6 - 1.3) / 0.925)


# -- the two views, and the heading ------------------------------------------------------------------------------------


@settings(max_examples=30)
@given(steps)
def test_feet_clockwise_and_metres_counter_clockwise_agree(values: list[tuple[float, float, float]]) -> None:
    feet, metres = theory(), theory()
    for left, right, seconds in values:
        x, y, angle = feet.get_distance(-left, right, seconds)
        moved = metres.calculate(left, -right, seconds)
        assert isinstance(moved, Transform2d)
        assert (moved.x, moved.y) == pytest.approx((x * 0.3048, -y * 0.3048), abs=1e-12)
        assert math.remainder(moved.rotation().radians() + angle, math.tau) == pytest.approx(0, abs=1e-9)


def test_signs_are_the_documented_ones() -> None:
    forward, right_turn = theory(), theory()
    x, y, angle = forward.get_distance(-1, 1, 0.5)
    assert x > 1
    assert (y, angle) == (0, 0)
    assert forward.l_position == forward.r_position == x
    x, y, angle = right_turn.get_distance(-1, 0, 0.1)
    assert min(x, y, angle) > 0
    assert right_turn.l_velocity > 0 == right_turn.r_velocity
    moved = theory().calculate(1, 0, 0.1)
    assert moved.x > 0 > moved.y
    assert moved.rotation().radians() < 0


def test_heading_comes_from_the_moment_of_inertia() -> None:
    model = theory()
    assert model.inertia.to("lb * ft**2").magnitude == pytest.approx(108.776, abs=1e-3)
    track = Track(model)
    track.drive(1, -1, 2, count=100)
    assert track.angle == pytest.approx(2.0 / 2 * 90 / 108.776 * (model.l_position - model.r_position), rel=1e-5)

    heavier = theory()
    heavier.inertia = heavier.inertia.to("kg * m**2") * 2
    slower = Track(heavier)
    slower.drive(1, -1, 2)
    assert slower.angle == pytest.approx(track.angle / 2)


@settings(max_examples=30)
@given(steps)
def test_heading_of_wheels_that_do_not_slip(values: list[tuple[float, float, float]]) -> None:
    model = theory()
    model.inertia = MASS * WHEELBASE**2 / 2
    track = Track(model)
    for step in values:
        track.drive(*step)
    assert track.angle == pytest.approx((model.l_position - model.r_position) / 2.0, abs=1e-9)


# -- theory, and what cannot be ----------------------------------------------------------------------------------------


def test_theory_has_the_documented_equations_and_says_what_came_of_them(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, "pyfrc.physics"):
        model = theory()
    assert "vmax=12.980 ft/s, amax=54.671 ft/s^2, kv=0.925, ka=0.219" in caplog.text
    assert "2 CIM motors @ 10.71 gearing" in caplog.text
    model.get_distance(-1, 1, 60)
    assert model.l_velocity == pytest.approx(12.980 * (12 - 1.3) / 12, rel=1e-4)


def test_any_units_will_do() -> None:
    metric = theory(
        robot_mass=90 * 0.45359237 * units.kg, x_wheelbase=0.6096 * units.metre, wheel_diameter=15.24 * units.cm
    )
    assert metric.get_distance(-1, 0.3, 0.3) == pytest.approx(theory().get_distance(-1, 0.3, 0.3))


@for_each(
    "parameters, error",
    [
        (
            {"robot_mass": 90 * units.foot},
            "robot_mass: 90 foot is a length, a mass was expected, such as 90 * units.lbs",
        ),
        ({"robot_mass": 90}, "robot_mass: 90 has no unit, a mass was expected"),
        ({"x_wheelbase": 2 * units.lbs}, "x_wheelbase: 2 pound is a mass, a length was expected"),
        ({"vintercept": 1 * units.amp}, "vintercept: 1 ampere is a current, a voltage was expected"),
        ({"timestep": 5 * units.inch}, "timestep: 5 inch is a length, a time was expected"),
        ({"wheel_diameter": units.inch}, "wheel_diameter: inch is a unit without a number, a length was expected"),
    ],
)
def test_a_wrong_dimension_is_named(parameters: dict[str, Any], error: str) -> None:
    with pytest.raises(WrongDimension) as raised:
        theory(**parameters)
    assert error in str(raised.value)


@for_each(
    "parameters",
    [
        {"robot_mass": -90 * units.lbs},
        {"robot_mass": math.nan * units.lbs},
        {"gearing": 0},
        {"gearing": math.inf},
        {"nmotors": 0},
        {"nmotors": 1.5},
        {"robot_width": 0 * units.inch},
        {"vintercept": -1 * units.volt},
        {"timestep": 0 * units.ms},
    ],
)
def test_a_value_that_cannot_be_names_its_parameter(parameters: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match=next(iter(parameters))):
        theory(**parameters)


@for_each("unit", ["rpm", "rad / second", "turn / minute"])
def test_a_free_speed_in_radians_is_a_warning(unit: str) -> None:
    motor = MOTOR_CFG_NEO._replace(freeSpeed=5676 * units(unit))
    with pytest.warns(UserWarning, match=r"Use units\.cpm") as warned:
        TankModel.theory(motor, MASS, 10.71)
    assert warned[0].filename == __file__


def test_with_all_its_motors_a_robot_accelerates_as_force_and_mass_say() -> None:
    model = TankModel.theory(
        MOTOR_CFG_NEO, 50 * units.kg, 8.45, 4, wheel_diameter=15 * units.cm, vintercept=0 * units.volt
    )
    newtons = 4 * MOTOR_CFG_NEO.stallTorque.m_as("N_m") * 8.45 / 0.075
    model.calculate(1, -1, 1e-4)
    assert model.l_velocity * 0.3048 / 1e-4 == pytest.approx(newtons / 50, rel=0.001)


def test_what_is_no_motor_is_told() -> None:
    with pytest.raises(ParameterError, match="motor_config"):
        TankModel.theory("CIM", MASS, 10.71)  # type: ignore[arg-type]


@for_each("step, name", [((math.nan, 0, 0.02), "l_motor"), ((0, math.nan, 0.02), "r_motor")])
def test_nan_never_gets_into_the_pose(step: tuple[float, float, float], name: str) -> None:
    model = theory()
    with pytest.raises(ParameterError, match=name):
        model.get_distance(*step)
    assert model.l_position == model.r_position == 0


@for_each("seconds", [-0.02, math.nan, math.inf])
def test_time_does_not_run_backwards(seconds: float) -> None:
    model = TankModel.theory(MOTOR_CFG_NEO, MASS, 10.71)
    with pytest.raises(ParameterError, match="tm_diff"):
        model.calculate(1, -1, seconds)
    assert model.get_distance(-1, 1, 0) == (0, 0, 0)
    assert model.get_distance(-1, 1, 0.02)[0] > 0
