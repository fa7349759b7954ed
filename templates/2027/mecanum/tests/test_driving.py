"""How the robot moves when the driver uses the sticks.

`physics_controller` has the robot's pose: x and y in metres (y grows to the left), its rotation counter-clockwise.
"""

import pytest
from ntcore.util import SelectableControl
from wpilib.simulation import XboxControllerSim


def drive(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


def test_the_left_stick_moves_without_turning(control, robot, physics_controller):
    start = physics_controller.get_pose()
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_left_y(-0.7)  # forward
        gamepad.set_left_x(0.7)  # to the right
        drive(control, 1)
        moved = physics_controller.get_pose().relative_to(start)
    assert moved.x > 0.5
    assert moved.y == pytest.approx(-moved.x, abs=0.01)
    assert moved.rotation().degrees() == pytest.approx(0, abs=0.1)


@pytest.mark.parametrize("as_seen_from_the_robot", [False, True])
def test_forward_after_a_quarter_turn(control, robot, physics_controller, as_seen_from_the_robot):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_right_x(-0.5)
        while physics_controller.get_pose().rotation().degrees() < 90:
            drive(control, 0.02)
        gamepad.set_right_x(0)
        drive(control, 0.1)
        assert robot.gyro.get_rotation2d().degrees() == pytest.approx(95, abs=10)

        start = physics_controller.get_pose().translation()
        gamepad.set_left_y(-1.0)
        gamepad.set_left_bumper_button(as_seen_from_the_robot)
        drive(control, 1)
        moved = physics_controller.get_pose().translation() - start
    along, across = (moved.y, moved.x) if as_seen_from_the_robot else (moved.x, moved.y)
    assert along > 1
    assert abs(across) < 0.3 * along


def test_the_back_button_makes_this_way_forward(control, robot):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_right_x(0.5)
        drive(control, 0.5)
        assert robot.gyro.get_rotation2d().degrees() < -20
        gamepad.set_right_x(0)
        gamepad.set_view_button(True)
        drive(control, 0.1)
        assert robot.gyro.get_rotation2d().degrees() == pytest.approx(0, abs=1)


def test_autonomous_goes_forward_then_right(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        control.step_timing(seconds=2, autonomous=True, enabled=True)
        half_way = physics_controller.get_pose().relative_to(start)
        assert half_way.x > 2
        assert abs(half_way.y) < 0.05
        control.step_timing(seconds=3, autonomous=True, enabled=True)
        moved = physics_controller.get_pose().relative_to(start)
        assert moved.x == pytest.approx(half_way.x, abs=0.1)
        assert moved.y < -1.5


def test_the_robot_knows_where_it_is(control, robot, physics_controller):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_left_y(-0.6)
        gamepad.set_left_x(0.4)
        gamepad.set_right_x(0.3)
        drive(control, 1.5)
        believed, really = robot.field.get_robot_pose(), physics_controller.get_pose()
    assert believed.translation().distance(really.translation()) < 0.1
    assert (believed.rotation() - really.rotation()).degrees() == pytest.approx(0, abs=3)


def test_stay_is_a_choice_for_autonomous(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        SelectableControl("Autonomous").set_selected("Stay")
        control.step_timing(seconds=0.1, autonomous=True, enabled=False)  # chosen before the match
        control.step_timing(seconds=3, autonomous=True, enabled=True)
    assert physics_controller.get_pose() == start
