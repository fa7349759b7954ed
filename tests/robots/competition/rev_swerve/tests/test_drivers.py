"""What the drivers' sticks and buttons do."""

import math

import pytest

FORWARD, AIM = 1, 3  # axes of the driver's gamepad
SCORE = 6  # button of the operator's gamepad


def test_drives_forward(control, hal_data, robot, physics_controller):
    hal_data["alliance_station"] = "blue1"
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        start = physics_controller.get_pose()
        hal_data["joysticks"][0]["axes"][FORWARD] = -0.8
        control.step_timing(seconds=1.5, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["axes"][FORWARD] = 0
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        driven = physics_controller.get_pose().relativeTo(start)
        assert 2 < driven.X() < 6
        assert abs(driven.Y()) < 0.1
        assert robot.container.drivetrain.speeds().vx == pytest.approx(0, abs=0.05)


def test_aims_at_the_hub(control, hal_data, robot, physics_controller):
    hal_data["alliance_station"] = "blue1"
    hal_data["joysticks"][0]["axes"][AIM] = 1.0
    with control.run_robot():
        # without an autonomous before it, the robot does not know where it is
        robot.container.drivetrain.reset_pose(physics_controller.get_pose())
        control.step_timing(seconds=3, autonomous=False, enabled=True)
        pose = physics_controller.get_pose()
        direction = math.atan2(4.03 - pose.Y(), 4.63 - pose.X())
        assert abs(math.remainder(pose.rotation().radians() - direction, math.tau)) < math.radians(4)


def test_shoots(control, hal_data, robot):
    highest = fastest = 0.0
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        shooter, elevator = robot.container.shooter, robot.container.elevator
        assert shooter.has_piece()
        hal_data["joysticks"][1]["buttons"][SCORE] = True
        for _ in range(250):
            control.step_timing(seconds=0.02, autonomous=False, enabled=True)
            highest, fastest = max(highest, elevator.height()), max(fastest, shooter.speed())
        assert not shooter.has_piece()
        assert 0.5 < highest < 0.65
        assert 4000 < fastest < 4500
        assert elevator.height() < 0.05


def test_nothing_moves_while_disabled(control, hal_data, robot, physics_controller):
    with control.run_robot():
        control.step_timing(seconds=0.1, autonomous=False, enabled=False)
        start = physics_controller.get_pose()
        hal_data["joysticks"][0]["axes"][FORWARD] = -1.0
        control.step_timing(seconds=2, autonomous=False, enabled=False)
        assert physics_controller.get_pose().translation().distance(start.translation()) < 0.01
        assert robot.container.elevator.height() < 0.01
