"""REV's and CTRE's motor controllers, with their libraries of 2027: physics, closed loops, what repeats."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import pytest
from conftest import MakeProject
from skips import requires

pytestmark = requires(
    "vendors' devices of 2027",
    [name for name in ("robotpy-rev", "phoenix6") if not find_spec(name.removeprefix("robotpy-"))],
)

ROBOTS = Path(__file__).parents[1] / "robots" / "season_2027"

REV_ROBOT = """
    import rev
    import wpilib

    BUS = wpilib.CANPort.CAN_S0
    BRUSHLESS = rev.SparkMax.MotorType.BRUSHLESS
    SAFELY = rev.ResetMode.RESET_SAFE_PARAMETERS, rev.PersistMode.PERSIST_PARAMETERS


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.left_motor = rev.SparkMax(BUS, 1, BRUSHLESS)
            self.right_motor = rev.SparkMax(BUS, 2, BRUSHLESS)
            self.right_motor.configure(rev.SparkMaxConfig().inverted(True), *SAFELY)
            self.follower = rev.SparkMax(BUS, 3, BRUSHLESS)
            self.follower.configure(rev.SparkMaxConfig().follow(1), *SAFELY)
            self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)
            self.flywheel = rev.SparkFlex(BUS, 7, BRUSHLESS)
            config = rev.SparkFlexConfig()
            config.closed_loop.pid(0.0002, 0.0, 0.0)
            config.closed_loop.feed_forward.v(12 / 6784)
            self.flywheel.configure(config, *SAFELY)
            self.arm = rev.SparkMax(wpilib.CANPort.CAN_S1, 7, BRUSHLESS)
            config = rev.SparkMaxConfig()
            config.closed_loop.set_feedback_sensor(rev.FeedbackSensor.ABSOLUTE_ENCODER).pid(4.0, 0.0, 0.0)
            self.arm.configure(config, *SAFELY)
            self.stick = wpilib.Joystick(0)

        def teleop_periodic(self):
            self.drive.arcade_drive(-self.stick.get_y(), -self.stick.get_x())

        def autonomous_periodic(self):
            velocity, position = rev.SparkMax.ControlType.VELOCITY, rev.SparkMax.ControlType.POSITION
            self.flywheel.get_closed_loop_controller().set_setpoint(3000, velocity)
            self.arm.get_closed_loop_controller().set_setpoint(0.25, position)

        def disabled_init(self):
            self.drive.stop_motor()
"""

REV_TEST = """
    from pytest import approx


    def test_a_drivetrain_moves_and_stands_while_it_is_disabled(control, hal_data, robot, physics_controller):
        start = physics_controller.get_pose()
        with control.run_robot():
            hal_data["joysticks"][0]["axes"][1] = -1.0
            control.step_timing(seconds=1, autonomous=False, enabled=True)
            assert physics_controller.get_pose().relative_to(start).x > 1
            assert robot.left_motor.get_encoder().get_position().get() > 1
            assert hal_data["CAN"]["SPARK MAX [0,1]"]["Applied Output"] == approx(1.0)
            control.step_timing(seconds=0.5, autonomous=False, enabled=False)
            here = physics_controller.get_pose()
            control.step_timing(seconds=0.5, autonomous=False, enabled=False)
            assert physics_controller.get_pose() == here


    def test_closed_loops(control, robot):
        with control.run_robot():
            control.step_timing(seconds=4, autonomous=True, enabled=True)
            assert robot.flywheel.get_encoder().get_velocity().get() == approx(3000, rel=0.05)
            assert robot.arm.get_absolute_encoder().get_position().get() == approx(0.25, abs=0.02)
"""

CTRE_ROBOT = """
    import wpilib
    from phoenix6 import CANBus, configs, controls, hardware, signals

    BUS = CANBus("can_s0")


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.left_motor = hardware.TalonFX(1, BUS)
            self.right_motor = hardware.TalonFX(2, BUS)
            output = configs.MotorOutputConfigs().with_inverted(signals.InvertedValue.CLOCKWISE_POSITIVE)
            self.right_motor.configurator.apply(output)
            self.flywheel = hardware.TalonFX(3, CANBus("can_s1"))
            self.flywheel.configurator.apply(configs.Slot0Configs().with_k_v(0.12).with_k_p(0.2))
            self.power = controls.DutyCycleOut(0)
            self.speed = controls.VelocityVoltage(0)
            self.stick = wpilib.Joystick(0)

        def teleop_periodic(self):
            forward, turn = -self.stick.get_y(), -self.stick.get_x()
            self.left_motor.set_control(self.power.with_output(forward - turn))
            self.right_motor.set_control(self.power.with_output(forward + turn))

        def autonomous_periodic(self):
            self.flywheel.set_control(self.speed.with_velocity(50))
"""

CTRE_TEST = """
    from pytest import approx


    def test_a_drivetrain_moves(control, hal_data, robot, physics_controller):
        start = physics_controller.get_pose()
        with control.run_robot():
            control.step_timing(seconds=0.5, autonomous=False, enabled=True)
            hal_data["joysticks"][0]["axes"][1] = -1.0
            control.step_timing(seconds=2, autonomous=False, enabled=True)
            assert physics_controller.get_pose().relative_to(start).x > 1
            assert robot.left_motor.get_position().value > 1


    def test_a_closed_loop(control, robot):
        with control.run_robot():
            control.step_timing(seconds=5, autonomous=True, enabled=True)
            assert robot.flywheel.get_velocity().value == approx(50, rel=0.1)
"""


def test_sparks(make_project: MakeProject) -> None:
    """On two buses, two devices with one number; a recording equals what is replayed, but for the devices."""
    project = make_project({"robot.py": REV_ROBOT, "tests/test_robot.py": REV_TEST})
    made = project.run("create-physics")
    assert made.code == 0, made.output
    for device in ("left: SPARK MAX [0,1] (left_motor)", "SPARK Flex [0,7] (flywheel)", "SPARK MAX [1,7] (arm)"):
        assert device in made.stdout
    result = project.run("test", "--record", "recorded")
    assert result.code == 0, result.output
    assert "REV's library draws the noise" in result.output
    replayed = project.run("replay", "recorded/tests_test_robot.py.test_closed_loops.jsonl")
    assert replayed.code == 0, replayed.output
    assert "The trace equals the recorded one." in replayed.stdout


@pytest.mark.slow
def test_a_swerve_drive_on_sparks(make_project: MakeProject) -> None:
    """It drives, and its odometry agrees, with the physics that `create-physics` writes."""
    project = make_project({})
    project.copy(ROBOTS / "rev_swerve")
    made = project.run("create-physics")
    assert made.code == 0, made.output
    assert "swerve drive\n  SPARK MAX [0,2] (modules[front_left].drive) drives" in made.stdout
    result = project.run("test", "--", "-k", "swerve or practice")
    assert result.code == 0, result.output
    assert "4 passed" in result.stdout


@pytest.mark.slow
def test_talons(make_project: MakeProject) -> None:
    project = make_project({"robot.py": CTRE_ROBOT, "tests/test_robot.py": CTRE_TEST})
    made = project.run("create-physics")
    assert made.code == 0, made.output
    assert "mechanism: CANMotor:Talon FX (v6)[3] (flywheel)" in made.stdout
    result = project.run("test")
    assert result.code == 0, result.output
