"""`pyfrc.physics.can_motors`: the motion of mechanisms and swerve drives, without any vendor's device."""

from __future__ import annotations

import math
from typing import Any

import pytest
from wpimath.geometry import Translation2d
from wpimath.system.plant import DCMotor

from pyfrc.physics.can_motors import Mechanism, SwerveDrive, SwerveModule


class FakeController:
    """A motor controller with a given output."""

    def __init__(self, value: float, motor: Any = None, gearing: float = 10.0) -> None:
        self.value, self.motor, self.gearing = value, motor or DCMotor.NEO(1), gearing
        self.measured: list[tuple[float, float]] = []

    def steps(self) -> int:
        return 1

    def output(self) -> float:
        return self.value

    def measure(self, turns: float, speed: float, tm_diff: float) -> None:
        self.measured.append((turns, speed))


def test_a_mechanism_reaches_its_motors_speed_and_stops_at_its_end() -> None:
    controller = FakeController(0.5)
    mechanism = Mechanism(controller, 0.02, high=30)
    for _ in range(100):
        mechanism.update(0.02)
    # A NEO makes 5676 turns a minute with 12 V.
    assert mechanism.speed == pytest.approx(5676 / 60 / 10 / 2, rel=0.03)
    assert 0 < mechanism.turns < 2 * mechanism.speed
    for _ in range(500):
        mechanism.update(0.02)
    assert (mechanism.turns, mechanism.speed) == (30, 0)
    assert controller.measured[-1] == (30, 0)


def test_a_step_of_no_time_moves_nothing() -> None:
    controller = FakeController(1.0)
    mechanism = Mechanism(controller, 0.02)
    mechanism.update(0.0)
    assert (mechanism.turns, mechanism.speed, controller.measured) == (0, 0, [])


def test_a_swerve_drive_moves_as_its_wheels() -> None:
    places = [(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)]

    def drive(angles: list[float]) -> SwerveDrive:
        modules = []
        for (x, y), angle in zip(places, angles, strict=True):
            driving, steering = Mechanism(FakeController(1.0), 1e-6), Mechanism(FakeController(0.0), 1e-6)
            steering.turns = angle
            modules.append(SwerveModule(driving, steering, x, y, 0.1))
        return SwerveDrive(*modules)

    speed = 5676 / 60 / 10 * math.pi * 0.1
    for angle, (vx, vy) in {0.0: (speed, 0), 0.25: (0, speed), 0.5: (-speed, 0)}.items():
        speeds = drive([angle] * 4).update(0.02)
        assert (speeds.vx, speeds.vy, speeds.omega) == pytest.approx((vx, vy, 0), rel=0.03, abs=0.001)
    around = [math.atan2(x, -y) / math.tau for x, y in places]
    speeds = drive(around).update(0.02)
    assert (speeds.vx, speeds.vy) == pytest.approx((0, 0), abs=0.001)
    assert speeds.omega == pytest.approx(speed / math.hypot(0.3, 0.2), rel=0.03)


class Wheel:
    """A module of a swerve drive with a given velocity."""

    def __init__(self, place: tuple[float, float], velocity: tuple[float, float]) -> None:
        self.place, self.velocity = Translation2d(*place), Translation2d(*velocity)

    def update(self, tm_diff: float) -> Translation2d:
        return self.velocity


def test_the_wheels_of_a_swerve_drive_may_be_anywhere() -> None:
    vx, vy, omega = 1.0, -2.0, 3.0
    places = [(0.5, 0.1), (0.2, -0.3), (-0.1, 0.4)]
    wheels: list[Any] = [Wheel((x, y), (vx - omega * y, vy + omega * x)) for x, y in places]
    speeds = SwerveDrive(*wheels).update(0.02)
    assert (speeds.vx, speeds.vy, speeds.omega) == pytest.approx((vx, vy, omega))
