"""What pyfrc replaces inside WPILib's simulation: when this fails, robots whose physics has noise no longer repeat."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import pytest
from conftest import SHORT_MATCH, MakeProject, trace_hash
from wpilib.simulation import DCMotorSim, DifferentialDrivetrainSim, ElevatorSim, FlywheelSim, SingleJointedArmSim
from wpimath.system.plant import DCMotor, LinearSystemId

from pyfrc_core.compat.wpilib_noise import replace_chance, seed_mechanism_noise

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the noise of WPILib's mechanisms: needs Linux")

NEO = DCMotor.NEO(2)
DEVIATION = 0.01

#: WPILib's simulation, and what measures something of it.
Mechanism = tuple[Any, Callable[[], float]]


def flywheel() -> Mechanism:
    sim = FlywheelSim(LinearSystemId.flywheelSystem(NEO, 0.01, 1.0), NEO, [DEVIATION])
    return sim, sim.getAngularVelocity


def motor() -> Mechanism:
    sim = DCMotorSim(LinearSystemId.DCMotorSystem(NEO, 0.01, 1.0), NEO, [DEVIATION] * 2)
    return sim, sim.getAngularPosition


def elevator() -> Mechanism:
    sim = ElevatorSim(NEO, 10.0, 5.0, 0.05, -1.0, 2.0, False, 0.0, [DEVIATION] * 2)
    return sim, sim.getPosition


def arm() -> Mechanism:
    sim = SingleJointedArmSim(NEO, 100.0, 1.0, 0.5, -1.0, 2.0, False, 0.0, [DEVIATION] * 2)
    return sim, sim.getAngle


def drivetrain() -> Mechanism:
    sim = DifferentialDrivetrainSim(NEO, 10.0, 5.0, 50.0, 0.07, 0.6, [DEVIATION] * 7)
    return sim, sim.getLeftPosition


@pytest.mark.parametrize("mechanism", [flywheel, motor, elevator, arm, drivetrain])
def test_the_noise_of_mechanisms_is_seeded(mechanism: Callable[[], Mechanism]) -> None:
    def draws(seed: int) -> list[float]:
        seed_mechanism_noise(seed)
        sim, measured = mechanism()
        values = []
        for _ in range(500):
            sim.update(0.02)
            values.append(measured())
        return values

    assert replace_chance()
    first = draws(5)
    assert draws(5) == first
    assert draws(6) != first
    # It is still WPILib's noise: at rest, with the standard deviation that was asked for.
    mean = sum(first) / len(first)
    deviation = (sum((value - mean) ** 2 for value in first) / len(first)) ** 0.5
    assert abs(mean) < DEVIATION / 5
    assert 0.8 * DEVIATION < deviation < 1.2 * DEVIATION


def test_a_robot_whose_physics_has_noise_repeats(make_project: MakeProject) -> None:
    project = make_project(
        {
            "pyproject.toml": SHORT_MATCH,
            "robot.py": """
                import wpilib


                class MyRobot(wpilib.TimedRobot):
                    def robotInit(self):
                        self.motor = wpilib.PWMSparkMax(0)
                        self.encoder = wpilib.Encoder(0, 1)

                    def teleopPeriodic(self):
                        self.motor.set(0.7 - self.encoder.getRate() / 1000)
            """,
            "physics.py": """
                from wpilib.simulation import EncoderSim, FlywheelSim
                from wpimath.system.plant import DCMotor, LinearSystemId


                class PhysicsEngine:
                    def __init__(self, physics_controller, robot):
                        neo = DCMotor.NEO(1)
                        self.robot = robot
                        self.flywheel = FlywheelSim(LinearSystemId.flywheelSystem(neo, 0.01, 1.0), neo, [0.5])
                        self.encoder = EncoderSim(robot.encoder)

                    def update_sim(self, now, tm_diff):
                        self.flywheel.setInputVoltage(12 * self.robot.motor.get())
                        self.flywheel.update(tm_diff)
                        self.encoder.setRate(self.flywheel.getAngularVelocity())
            """,
        }
    )
    traces = []
    for run, isolation in enumerate(("fork", "spawn", "none")):
        directory = project.path / f"run{run}"
        result = project.run("test", "--builtin", "--isolation", isolation, "--record", directory)
        assert result.code == 0, result.output
        traces.append(directory / "pyfrc.tests.test_practice.trace.jsonl")
    assert len({trace_hash(trace) for trace in traces}) == 1
    script = traces[0].with_name("pyfrc.tests.test_practice.jsonl")
    replayed = project.run("replay", script)
    assert replayed.code == 0, replayed.output
    other = project.path / "other"
    assert project.run("test", "--builtin", "--seed", "7", "--record", other).code == 0
    assert trace_hash(other / traces[0].name) != trace_hash(traces[0])
