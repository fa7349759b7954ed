"""What the drivers rely on: the robot goes where the sticks say, shoots what it has, and climbs."""

import math

import hal
import pytest
from wpilib.simulation import DriverStationSim, SendableChooserSim, XboxControllerSim


@pytest.fixture
def driver():
    return XboxControllerSim(0)


@pytest.fixture
def operator():
    return XboxControllerSim(1)


def step(control, seconds, enabled=True, autonomous=False):
    """Send what the gamepads hold now, and run on."""
    DriverStationSim.notifyNewData()
    control.step_timing(seconds=seconds, autonomous=autonomous, enabled=enabled)


def test_odometry_agrees_with_the_field(control, robot, driver, physics_controller):
    with control.run_robot():
        DriverStationSim.setAllianceStationId(hal.AllianceStationID.kBlue1)
        step(control, 0.5, enabled=False)
        start, believed = physics_controller.get_pose(), robot.swerve.pose()
        driver.setLeftY(-0.7)
        driver.setLeftX(0.4)
        step(control, 1.5)
        driver.setRightX(-0.5)
        step(control, 1.0)
        driver.setLeftY(0)
        driver.setLeftX(0)
        driver.setRightX(0)
        step(control, 1.0)
        moved = physics_controller.get_pose().relativeTo(start)
        thought = robot.swerve.pose().relativeTo(believed)
        assert moved.X() > 2
        assert moved.Y() < -0.3
        assert moved.rotation().degrees() > 30
        assert moved.translation().distance(thought.translation()) < 0.05
        assert abs((moved.rotation() - thought.rotation()).degrees()) < 1


def test_a_robot_that_stands_still_is_where_it_was(control, robot):
    with control.run_robot():
        step(control, 1.0, enabled=False)
        assert robot.swerve.pose().translation().norm() < 0.001
        assert robot.diagnostics.get_healthy()


def test_the_preload_is_shot(control, robot):
    with control.run_robot():
        step(control, 0.5, enabled=False)
        assert robot.indexer.balls == 3
        step(control, 10, autonomous=True)
        assert robot.indexer.shot == 3
        assert robot.indexer.balls == 0


def test_collects_until_full(control, robot, operator):
    with control.run_robot():
        step(control, 0.2, enabled=False)
        operator.setAButton(True)
        step(control, 1.0)
        assert robot.intake.is_down()
        step(control, 6.0)
        assert robot.indexer.balls >= 5
        operator.setAButton(False)
        step(control, 2.0)
        assert math.degrees(robot.intake.get_angle()) > 85


def test_climbs(control, robot, operator):
    with control.run_robot():
        step(control, 0.2, enabled=False)
        operator.setPOV(0)
        step(control, 2.5)
        assert robot.climber.get_height() > 0.5
        operator.setPOV(180)
        step(control, 3.0)
        assert robot.climber.get_height() < 0.05
        assert robot.climb_control.lifted


@pytest.mark.parametrize("mode", ["Preload", "Depot", "Shoot and climb", "Square"])
def test_autonomous_modes(control, robot, mode):
    with control.run_robot():
        step(control, 0.2, enabled=False)
        chooser = SendableChooserSim("/SmartDashboard/Autonomous Mode/")
        chooser.setSelected(mode)
        step(control, 0.2, enabled=False)
        before = robot.swerve.pose()
        step(control, 15, autonomous=True)
        assert robot.swerve.pose().translation().distance(before.translation()) > 1
