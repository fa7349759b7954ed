"""`pyfrc create-physics` for motors on REV's and CTRE's motor controllers: what it writes runs and moves them."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject
from skips import missing_python, requires

COMPETITION = Path(__file__).parent / "robots" / "competition"

pytestmark = requires("robots with vendors' packages", missing_python())


def create(project: RobotProject) -> str:
    """Run the command, which must succeed; return its output."""
    result = project.run("create-physics")
    assert result.code == 0, result.output
    return result.stdout


def run_test(project: RobotProject, code: str) -> None:
    tests = project.path / "tests"
    shutil.rmtree(tests, ignore_errors=True)
    tests.mkdir()
    (tests / "test_physics.py").write_text(code)
    result = project.run("test")
    assert result.code == 0, result.output


def competition_robot(make_project: MakeProject, name: str) -> RobotProject:
    """Return a robot without its own physics, and without its tests, which know its numbers."""
    project = make_project({})
    project.copy(COMPETITION / name, "physics.py", "sim", "tests")
    return project


SPARKS = """
import math

import rev
import wpilib


def spark(number, configure, kind=rev.SparkMax):
    motor = kind(number, rev.SparkLowLevel.MotorType.kBrushless)
    config = rev.SparkMaxConfig() if kind is rev.SparkMax else rev.SparkFlexConfig()
    configure(config)
    motor.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
    return motor


def of_arm(config):
    # Degrees of the arm, behind a gearing of 100.
    config.encoder.positionConversionFactor(3.6).velocityConversionFactor(3.6 / 60)
    config.closedLoop.pid(0.02, 0, 0)
    config.smartCurrentLimit(40).inverted(True)


def of_wrist(config):
    config.absoluteEncoder.positionConversionFactor(math.tau).velocityConversionFactor(math.tau / 60)
    config.closedLoop.setFeedbackSensor(rev.FeedbackSensor.kAbsoluteEncoder).pid(0.5, 0, 0)
    config.closedLoop.positionWrappingEnabled(True).positionWrappingInputRange(0, math.tau)


def of_flywheel(config):
    config.closedLoop.pid(0.0001, 0, 0).feedForward.kV(12 / 6784)


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.arm_motor = spark(1, of_arm)
        self.wrist = {"motor": spark(2, of_wrist)}
        self.shooter = spark(3, of_flywheel, rev.SparkFlex)
        self.second_shooter = spark(4, lambda config: config.follow(self.shooter, True), rev.SparkFlex)
        self.arm_encoder = self.arm_motor.getEncoder()
        self.wrist_encoder = self.wrist["motor"].getAbsoluteEncoder()

    def autonomousPeriodic(self):
        kind = rev.SparkLowLevel.ControlType
        self.arm_motor.getClosedLoopController().setSetpoint(90, kind.kPosition)
        self.wrist["motor"].getClosedLoopController().setSetpoint(5.0, kind.kPosition)
        self.shooter.getClosedLoopController().setSetpoint(3000, kind.kVelocity)

    def teleopPeriodic(self):
        self.arm_motor.setVoltage(3)
        self.shooter.set(-0.25)
"""

SPARKS_TEST = """
from pytest import approx


def test_closed_loops(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=True, enabled=False)
        assert (robot.arm_encoder.getPosition(), robot.wrist_encoder.getPosition()) == (0, 0)
        # An encoder that does not close the loop measures too.
        control.step_timing(seconds=0.06, autonomous=True, enabled=True)
        assert abs(robot.wrist["motor"].getEncoder().getVelocity()) > 100
        highest = 0
        for _ in range(100):
            control.step_timing(seconds=0.02, autonomous=True, enabled=True)
            highest = max(highest, robot.arm_motor.getOutputCurrent())
            for number in 1, 2:
                assert abs(hal_data["CAN"][f"SPARK MAX [{number}]"]["Applied Output"]) <= 1
        # A position of 90 degrees and a speed of 3000 turns a minute are no powers.
        assert robot.arm_encoder.getPosition() == approx(90, abs=1)
        assert robot.arm_encoder.getVelocity() == approx(0, abs=1)
        assert robot.wrist_encoder.getPosition() == approx(5, abs=0.05)
        assert robot.shooter.getEncoder().getVelocity() == approx(3000, rel=0.05)
        assert robot.shooter.getAppliedOutput() == approx(3000 / 6784, rel=0.1)
        assert 0 < highest < 45
        # As a real one, the relative encoder goes on from what the robot has set; the arm stays where it is.
        robot.arm_encoder.setPosition(0)
        control.step_timing(seconds=2, autonomous=True, enabled=True)
        assert robot.arm_encoder.getPosition() == approx(90, abs=1)


def test_voltage_and_power(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=2, autonomous=False, enabled=True)
        # A NEO makes 5676 turns a minute with 12 V; an inverted motor's encoder turns with it.
        assert robot.arm_encoder.getVelocity() == approx(5676 / 4 / 60 * 3.6, rel=0.05)
        assert robot.shooter.getEncoder().getVelocity() == approx(-6784 / 4, rel=0.05)
        control.step_timing(seconds=2, autonomous=False, enabled=False)
        assert robot.shooter.getEncoder().getVelocity() == approx(0, abs=50)
"""


@pytest.mark.slow
def test_motors_in_closed_loops_move_by_their_mode(make_project: MakeProject) -> None:
    project = make_project({"robot.py": SPARKS})
    printed = create(project)
    assert "mechanism: SPARK MAX [1] (arm_motor)" in printed
    text = (project.path / "physics.py").read_text()
    assert "purpose is unknown" not in text
    # The gearing that makes its conversion factor one of degrees; a follower is another motor of its leader.
    assert "ARM_GEARING = 100 " in text
    assert "SHOOTER_MOTOR = DCMotor.neoVortex(2)" in text
    assert "Spark(robot.wrist['motor'], " in text
    run_test(project, SPARKS_TEST)


DRIVING = """
from pytest import approx


def test_driving(control, hal_data, robot, physics_controller):
    hal_data["alliance_station"] = "blue1"
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        drivetrain = robot.container.drivetrain
        start, seen = physics_controller.get_pose(), drivetrain.pose()

        def push(axis, seconds=0.8):
            before = physics_controller.get_pose()
            hal_data["joysticks"][0]["axes"][axis] = -0.8
            control.step_timing(seconds=seconds, autonomous=False, enabled=True)
            hal_data["joysticks"][0]["axes"][axis] = 0
            control.step_timing(seconds=1, autonomous=False, enabled=True)
            now = physics_controller.get_pose()
            # What the robot computes of its wheels' and its gyro's sensors is where it is.
            driven, measured = now.relativeTo(start), drivetrain.pose().relativeTo(seen)
            assert driven.translation().distance(measured.translation()) < {tolerance}
            assert (driven.rotation() - measured.rotation()).degrees() == approx(0, abs=2)
            return now.relativeTo(before)

        driven = push(1)
        assert driven.X() > 1 and abs(driven.Y()) < 0.1
        driven = push(0)
        assert driven.Y() > 1 and abs(driven.X()) < 0.1
        assert push(4, 0.4).rotation().degrees() > 20
"""


@pytest.mark.slow
def test_swerve_on_sparks_drives(make_project: MakeProject) -> None:
    """Its absolute encoders do not measure 0 when its wheels point ahead: each has another offset in the code."""
    project = competition_robot(make_project, "rev_swerve")
    printed = create(project)
    assert printed.startswith("swerve drive\n")
    assert "unknown: digital channel" in (project.path / "physics.py").read_text().replace("\n# ", " ")
    run_test(project, DRIVING.format(tolerance=0.05))


@pytest.mark.slow
def test_swerve_on_talons_moves(make_project: MakeProject) -> None:
    """Its devices run in real time, so how far and how straight it drives depends on how busy the machine is."""
    project = competition_robot(make_project, "ctre_swerve")
    assert create(project).startswith("swerve drive\n")
    text = (project.path / "physics.py").read_text()
    assert "from pyfrc.physics.can_motors import Mechanism, SwerveDrive, SwerveModule, Talon\n" in text
    assert "DRIVE_GEARING = 6.75 " in text
    run_test(
        project,
        """
def test_moving(control, hal_data, robot, physics_controller):
    hal_data["alliance_station"] = "blue1"
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        start = physics_controller.get_pose()
        hal_data["joysticks"][0]["axes"][1] = -0.8
        control.step_timing(seconds=2, autonomous=False, enabled=True)
        assert physics_controller.get_pose().translation().distance(start.translation()) > 0.5
        assert max(abs(module.drive_motor.get_position().value) for module in robot.container.drivetrain.modules) > 0.1
""",
    )
