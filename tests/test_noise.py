"""Noise that nothing can seed, of REV's SPARKs and WPILib's mechanisms: commands say that runs do not repeat."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from conftest import MakeProject, RobotProject
from loops import for_each
from skips import missing_python, require
from wpilib.simulation import (
    DCMotorSim,
    DifferentialDrivetrainSim,
    ElevatorSim,
    FlywheelSim,
    LinearSystemSim_1_1_1,
    SingleJointedArmSim,
)
from wpimath.system.plant import DCMotor, LinearSystemId

from pyfrc_core.compat import unrepeatable
from pyfrc_core.patch_table import patched
from pyfrc_core.runtime.patches import noise

NEO = DCMotor.NEO(1)
FLYWHEEL = LinearSystemId.flywheelSystem(NEO, 0.01, 1.0)
KITBOT = DifferentialDrivetrainSim.KitbotMotor.SingleNEOPerSide, DifferentialDrivetrainSim.KitbotGearing.k10p71

TESTS = {
    "tests/test_robot.py": """
        def test_teleop(control, robot):
            with control.run_robot():
                control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        """
}
SCRIPT = "tests_test_robot.py.test_teleop.jsonl"


def words(project: RobotProject, *args: str) -> str:
    """Run a command that succeeds, and return its output as one line of words."""
    result = project.run(*args)
    assert result.code == 0, result.output
    return " ".join(result.output.split())


# -- WPILib's mechanisms -----------------------------------------------------------------------------------------------

MAKE: dict[str, tuple[int, Callable[[list[float]], object]]] = {
    "DCMotorSim": (2, lambda deviations: DCMotorSim(LinearSystemId.DCMotorSystem(NEO, 0.01, 1.0), NEO, deviations)),
    "ElevatorSim": (2, lambda deviations: ElevatorSim(NEO, 10, 5, 0.05, -1, 2, False, 0, deviations)),
    "FlywheelSim": (1, lambda deviations: FlywheelSim(FLYWHEEL, NEO, measurementStdDevs=deviations)),
    "LinearSystemSim_1_1_1": (1, lambda deviations: LinearSystemSim_1_1_1(FLYWHEEL, deviations)),
    "SingleJointedArmSim": (2, lambda deviations: SingleJointedArmSim(NEO, 100, 1, 1, 0, 2, False, 0, deviations)),
    "DifferentialDrivetrainSim": (7, lambda deviations: DifferentialDrivetrainSim(NEO, 10, 5, 50, 0.1, 1, deviations)),
    "DifferentialDrivetrainSim of a kit": (
        7,
        lambda deviations: DifferentialDrivetrainSim.createKitbotSim(
            *KITBOT, DifferentialDrivetrainSim.KitbotWheelSize.kSixInch, deviations
        ),
    ),
}


@for_each("kind", MAKE)
def test_mechanisms_are_named_if_they_have_noise(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unrepeatable, "_noisy_mechanisms", set())
    count, make = MAKE[kind]
    with patched(noise.patches("createKitbotSim")):
        make([0.0] * count)
        assert unrepeatable.unrepeatable_devices(()) == ()
        make([0.0] * (count - 1) + [0.1])
        assert unrepeatable.unrepeatable_devices(()) == (f"wpilib {kind.split()[0]}",)


FLYWHEEL_ROBOT = """
    import wpilib
    from wpilib.simulation import FlywheelSim
    from wpimath.system.plant import DCMotor, LinearSystemId


    class Flywheel(FlywheelSim):
        def __init__(self, *noise):
            neo = DCMotor.NEO(1)
            super().__init__(LinearSystemId.flywheelSystem(neo, 0.01, 1.0), neo, *noise)


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.flywheel = Flywheel({noise})
            self.motor = wpilib.PWMSparkMax(0)

        def teleopPeriodic(self):
            self.flywheel.setInputVoltage(6.0)
            self.flywheel.update(0.02)
            self.motor.set(self.flywheel.getAngularVelocity() / 1000)
    """
MECHANISM = (
    "FlywheelSim does not repeat exactly, because WPILib draws the noise of its measurementStdDevs by chance: leave "
    "measurementStdDevs out in tests, and add noise with random.gauss."
)


def test_a_robot_whose_mechanism_has_noise_is_marked(make_project: MakeProject) -> None:
    project = make_project({"robot.py": FLYWHEEL_ROBOT.format(noise="[1.0]"), **TESTS})
    assert words(project, "test", "--record", "recorded").count(MECHANISM) == 1
    output = words(project, "replay", f"recorded/{SCRIPT}")
    assert output.count(MECHANISM) == 1
    assert "The trace differs from the recorded one, first at" in output
    assert words(project, "fuzz", "--runs", "1").count(MECHANISM) == 1


# -- REV's SPARKs ------------------------------------------------------------------------------------------------------


def test_sparks_are_marked_from_their_first_noise_on(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ["SPARK MAX [10]", "SPARK MAX [10] RELATIVE ENCODER", "SPARK Flex [9]", "Victor [3]"]
    monkeypatch.setattr(unrepeatable, "_noisy_libraries", set())
    assert unrepeatable.unrepeatable_devices(names) == ()
    assert not unrepeatable.is_unrepeatable('CAN["SPARK MAX [10]"].Velocity')
    unrepeatable.report_noise("rev")
    assert unrepeatable.is_unrepeatable('CAN["SPARK MAX [10]"].Velocity')
    assert not unrepeatable.is_real_time('CAN["SPARK MAX [10]"].Velocity')
    devices = unrepeatable.unrepeatable_devices(names)
    assert devices == ("rev SPARK Flex 9", "rev SPARK MAX 10")
    assert unrepeatable.explain_unrepeatable(devices) == (
        "SPARK Flex 9 and SPARK MAX 10 do not repeat exactly, because REV's library draws the noise of their "
        "velocities by chance: a trace's hash leaves out their values, and tests should compare what depends on them "
        "with a tolerance."
    )
    unrepeatable.forget_noise()
    assert unrepeatable.unrepeatable_devices(names) == ()


def test_there_is_one_sentence_for_each_library() -> None:
    both = unrepeatable.explain_unrepeatable(["rev SPARK MAX 3", "wpilib FlywheelSim"])
    assert both.startswith("SPARK MAX 3 does not repeat exactly, ")
    assert both.endswith(f" with a tolerance. {MECHANISM}")


SPARK_ROBOT = """
    import rev
    import wpilib
    from wpimath.system.plant import DCMotor


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.spark = rev.SparkMax(3, rev.SparkMax.MotorType.kBrushless)
            self.model = DCMotor.NEO(1)
            self.simulated = rev.SparkMaxSim(self.spark, self.model)

        def teleopPeriodic(self):
            self.spark.set(0.5)
            {}
    """


@pytest.fixture
def spark_project(make_project: MakeProject, request: Any) -> RobotProject:
    require("REV's library", missing_python())
    return make_project({"robot.py": SPARK_ROBOT.format(request.param), **TESTS})


@pytest.mark.parametrize("spark_project", ["self.simulated.iterate(1000.0, 12.0, 0.02)"], indirect=True)
def test_a_simulated_spark_is_marked_and_the_rest_repeats(spark_project: RobotProject) -> None:
    output = words(spark_project, "test", "--record", "recorded")
    assert output.count("SPARK MAX 3 does not repeat exactly, because REV's library draws the noise") == 1
    output = words(spark_project, "replay", f"recorded/{SCRIPT}")
    assert "SPARK MAX 3 does not repeat exactly" in output
    assert "The trace equals the recorded one." in output
    (trace,) = (spark_project.path / "recorded").glob("*.trace.jsonl")
    assert '"unrepeatable":{"CAN[\\"SPARK MAX [3]\\"]' in trace.read_text("utf-8")
