"""`pyfrc.physics.can_motors`: how mechanisms and swerve drives move, without any vendor's device; a SPARK's sensors."""

from __future__ import annotations

import math
from typing import Any

import pytest
from conftest import MakeProject
from skips import missing_python, require
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


SPARK = {
    "robot.py": """
        import rev
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.spark = rev.SparkFlex(9, rev.SparkFlex.MotorType.kBrushless)
                config = rev.SparkFlexConfig()
                config.encoder.positionConversionFactor(2.0).velocityConversionFactor(3.0)
                config.externalEncoder.positionConversionFactor(5.0).velocityConversionFactor(7.0)
                config.absoluteEncoder.positionConversionFactor(360.0).velocityConversionFactor(6.0)
                config.closedLoop.setFeedbackSensor(rev.FeedbackSensor.{sensor})
                self.spark.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)

            def teleopInit(self):
                self.spark.getEncoder().setPosition(100.0)
                self.spark.getExternalEncoder().setPosition(50.0)

            def teleopPeriodic(self):
                self.spark.set(0.5)
        """,
    "physics.py": """
        from pyfrc.physics.can_motors import Mechanism, Spark
        from wpimath.system.plant import DCMotor


        class PhysicsEngine:
            def __init__(self, physics_controller, robot):
                robot.simulated = Spark(robot.spark, DCMotor.neoVortex(1), 10.0, zero=1.25)
                self.shaft = robot.shaft = Mechanism(robot.simulated, 0.02)

            def update_sim(self, now, tm_diff):
                self.shaft.update(tm_diff)
        """,
    "tests/test_sensors.py": """
        import pytest
        import rev


        def test_sensors(control, robot):
            with control.run_robot():
                absolute = robot.spark.getAbsoluteEncoder()
                assert absolute.getPosition() == pytest.approx(0.25 * 360)
                control.step_timing(seconds=2, autonomous=False, enabled=True)
                turns, speed = robot.shaft.turns, robot.shaft.speed
                # A NEO Vortex makes 6784 turns a minute with 12 V.
                assert speed == pytest.approx(6784 / 60 / 10 / 2, rel=0.05)
                assert absolute.getPosition() == pytest.approx((turns + 1.25) % 1 * 360, abs=0.1)
                assert absolute.getVelocity() == pytest.approx(speed * 60 * 6, rel=0.01)
                for encoder, began, position, velocity in (
                    (robot.spark.getEncoder(), 100, turns * 10 * 2, speed * 60 * 10 * 3),
                    (robot.spark.getExternalEncoder(), 50, turns * 5, speed * 60 * 7),
                ):
                    assert encoder.getPosition() - began == pytest.approx(position, rel=0.01)
                    assert encoder.getVelocity() == pytest.approx(velocity, rel=0.05)  # REV's library adds noise
                assert robot.simulated.steps() == 1
                robot.spark.getClosedLoopController().setReference(1.0, rev.SparkFlex.ControlType.kPosition)
                assert robot.simulated.steps() == 5
        """,
}


@pytest.mark.parametrize("sensor", ["kPrimaryEncoder", "kAbsoluteEncoder"])
def test_the_sensors_of_a_spark_follow_its_shaft_whichever_closes_the_loop(
    sensor: str, make_project: MakeProject
) -> None:
    require("REV's library", missing_python())
    project = make_project({**SPARK, "robot.py": SPARK["robot.py"].replace("{sensor}", sensor)})
    result = project.run("test")
    assert result.code == 0, result.output
