"""The robot's modes. `physics_controller` has the robot's pose, in metres."""

import pytest
from ntcore.util import SelectableControl
from wpilib.simulation import XboxControllerSim


def autonomous(control, seconds):
    control.step_timing(seconds=seconds, autonomous=True, enabled=True)


def test_autonomous_shoots_then_leaves(control, hal_data, robot, physics_controller):
    start = physics_controller.get_pose()
    fed = 0
    with control.run_robot():
        for _ in range(200):
            autonomous(control, 0.02)
            fed += hal_data["pwm"][3]["value"] > 0
        assert fed > 20
        assert physics_controller.get_pose().relative_to(start).x == pytest.approx(0, abs=0.1)
        autonomous(control, 4)
        assert physics_controller.get_pose().relative_to(start).x < -1


def test_nothing_is_nothing(control, robot, hal_data):
    with control.run_robot():
        dashboard = SelectableControl("Autonomous Mode")
        dashboard.set_selected("Nothing")
        control.step_timing(seconds=0.1, autonomous=True, enabled=False)  # chosen before the match
        for _ in range(50):
            autonomous(control, 0.1)
            assert [hal_data["pwm"][channel]["value"] for channel in range(4)] == [0, 0, 0, 0]


def test_the_sticks_drive_until_the_robot_is_disabled(control, hal_data, robot, physics_controller):
    start = physics_controller.get_pose()
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_left_y(-0.5)
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        assert physics_controller.get_pose().relative_to(start).x > 1
        control.step_timing(seconds=0.1, autonomous=False, enabled=False)
        assert hal_data["pwm"][0]["value"] == 0
