"""How the robot moves: `physics.py` moves it by its motors, `physics_controller` has its pose."""

import pytest


def test_the_encoders_measure_how_far_autonomous_drives(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        control.step_timing(seconds=5, autonomous=True, enabled=True)
        driven = physics_controller.get_pose().relative_to(start).x
        assert 2 < driven < 4
        assert robot.left_encoder.get_distance() == pytest.approx(driven, abs=0.01)
        assert robot.right_encoder.get_distance() == pytest.approx(driven, abs=0.01)


def test_the_robot_knows_where_it_is(control, hal_data, robot, physics_controller):
    hal_data["joysticks"][0]["axes"][1] = -0.9
    hal_data["joysticks"][1]["axes"][1] = -0.7  # in a curve to the right
    control.set_operator_control(enabled=True)
    control.run_test(lambda tm: tm < 2)

    believed, really = robot.field.get_robot_pose(), physics_controller.get_pose()
    assert believed.translation().distance(really.translation()) < 0.05
    assert (believed.rotation() - really.rotation()).degrees() == pytest.approx(0, abs=5)  # physics is a step ahead


def test_one_stick_turns_the_robot(control, hal_data, robot, physics_controller):
    start = physics_controller.get_pose()
    hal_data["joysticks"][0]["axes"][1] = -1.0  # the left side forward
    control.set_operator_control(enabled=True)
    control.run_test(lambda tm: tm < 0.5)

    turned = physics_controller.get_pose().relative_to(start).rotation().degrees()
    assert turned < -10  # clockwise
