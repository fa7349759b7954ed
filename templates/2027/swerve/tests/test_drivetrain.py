"""The whole drivetrain: does the robot move as requested, and is its odometry right?

`physics_controller` has the robot's true pose: x and y in metres, its rotation counter-clockwise.
"""

import math

import pytest
from ntcore.util import SelectableControl
from wpilib.simulation import XboxControllerSim

from drivetrain import START


def drive(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


@pytest.mark.parametrize("direction", [0, 45, 90, 180, 300])
def test_every_direction_without_turning(control, robot, physics_controller, direction):
    start = physics_controller.get_pose()
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_left_y(-0.6 * math.cos(math.radians(direction)))
        gamepad.set_left_x(-0.6 * math.sin(math.radians(direction)))
        drive(control, 2)
        moved = physics_controller.get_pose().relative_to(start)
    assert moved.translation().norm() > 2
    off = moved.translation().angle().degrees() - direction
    assert math.remainder(off, 360) == pytest.approx(0, abs=6)  # it moved while its wheels were still turning
    assert abs(moved.rotation().degrees()) < 10


def test_forward_is_away_from_the_driver_also_after_a_turn(control, robot, physics_controller):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_right_x(-0.5)
        while physics_controller.get_pose().rotation().degrees() < 90:
            drive(control, 0.02)
        gamepad.set_right_x(0)
        drive(control, 0.2)

        start = physics_controller.get_pose().translation()
        gamepad.set_left_y(-0.8)
        drive(control, 1)
        moved = physics_controller.get_pose().translation() - start
        assert moved.x > 1.5
        assert abs(moved.y) < 0.2 * moved.x

        gamepad.set_left_y(0)
        gamepad.set_view_button(True)
        drive(control, 0.5)
        assert robot.drivetrain.heading.degrees() == pytest.approx(0, abs=3)


def test_odometry_knows_where_the_robot_is(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        for _ in range(5):
            control.step_timing(seconds=1, autonomous=True, enabled=True)
            really = physics_controller.get_pose().relative_to(start)
            believed = robot.drivetrain.pose.relative_to(START)
            assert believed.translation().distance(really.translation()) < 0.1
            assert (believed.rotation() - really.rotation()).degrees() == pytest.approx(0, abs=5)
    assert really.x > 1.5
    assert really.y > 0.7
    assert really.rotation().degrees() > 60


def test_the_dashboard_shows_where_autonomous_goes(control, robot, physics_controller):
    with control.run_robot():
        control.step_timing(seconds=0.1, autonomous=True, enabled=False)
        path = robot.drivetrain.field.get_object("Path")
        *_, end = path.get_poses()
        control.step_timing(seconds=6, autonomous=True, enabled=True)
        assert end.translation().distance(physics_controller.get_pose().translation()) < 0.6

        SelectableControl("Autonomous").set_selected("Stay")
        control.step_timing(seconds=0.1, autonomous=True, enabled=False)
        assert len(path.get_poses()) == 1


def test_disabling_stops_every_motor(control, hal_data, robot):
    XboxControllerSim(0).set_left_y(-1)
    with control.run_robot():
        drive(control, 1)
        assert hal_data["pwm"][0]["value"] > 0.9
        control.step_timing(seconds=0.04, autonomous=False, enabled=False)
        assert [hal_data["pwm"][channel]["value"] for channel in range(8)] == [0] * 8
