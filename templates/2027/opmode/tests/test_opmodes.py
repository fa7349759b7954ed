"""Our own tests: select an opmode as on the driver station, and look at what the robot does.

`control` is the driver station, `hal_data` has the robot's inputs and outputs, and `physics_controller` has the
robot's pose: x and y in metres, its rotation counter-clockwise.
"""

import pytest
from wpilib.simulation import GamepadSim


def run(control, opmode, seconds):
    control.step_timing(seconds=seconds, opmode=opmode, enabled=True)


def test_leaves_the_line_and_stops(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        run(control, "Leave the line", 3)
        moved = physics_controller.get_pose().relative_to(start)
        assert moved.x == pytest.approx(1.5, abs=0.1)
        assert robot.distance() == pytest.approx(moved.x, abs=0.05)
        run(control, "Leave the line", 1)
        assert physics_controller.get_pose().relative_to(start) == moved


def test_stay_stays(control, hal_data, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        run(control, "Stay", 3)
    assert physics_controller.get_pose() == start


def test_the_sticks_drive_and_turn(control, robot, physics_controller):
    start = physics_controller.get_pose()
    gamepad = GamepadSim(0)
    with control.run_robot():
        gamepad.set_left_y(-1)
        run(control, "Drive", 1)
        assert physics_controller.get_pose().relative_to(start).x > 2
        gamepad.set_left_y(0)
        gamepad.set_right_x(-0.5)  # to the left
        run(control, "Drive", 0.5)
        assert robot.heading() > 30

        believed, really = robot.field.get_robot_pose(), physics_controller.get_pose()
        assert believed.translation().distance(really.translation()) < 0.1


def test_the_bumper_makes_it_slow(control, hal_data, robot):
    gamepad = GamepadSim(0)
    gamepad.set_left_y(-1)
    with control.run_robot():
        run(control, "Drive", 0.1)
        assert hal_data["pwm"][0]["value"] == 1
        gamepad.set_right_bumper_button(True)
        run(control, "Drive", 0.1)
        assert hal_data["pwm"][0]["value"] < 0.5


def test_after_autonomous_the_driver_takes_over(control, hal_data, robot):
    GamepadSim(0).set_left_y(0.5)
    with control.run_robot():
        run(control, "Leave the line", 0.5)
        assert hal_data["pwm"][0]["value"] > 0
        run(control, "Drive", 0.1)
        assert hal_data["pwm"][0]["value"] < 0


def test_a_disabled_robot_stands_still(control, hal_data, robot):
    with control.run_robot():
        run(control, "Leave the line", 0.5)
        control.step_timing(seconds=0.1, opmode="Leave the line", enabled=False)
        assert hal_data["pwm"][0]["value"] == 0


def test_the_check_runs_one_motor_after_the_other(control, hal_data, robot):
    def running():
        return [channel for channel in range(2) if hal_data["pwm"][channel]["value"] != 0]

    with control.run_robot():
        run(control, "Check the motors", 0.5)
        assert running() == [0]
        run(control, "Check the motors", 1)
        assert running() == [1]
        run(control, "Check the motors", 1)
        assert running() == []
