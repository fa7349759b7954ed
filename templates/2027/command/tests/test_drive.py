"""The drivetrain and its commands. `physics_controller` has the robot's pose, in metres."""

import pytest
from wpilib.simulation import XboxControllerSim

from commands.drivedistance import DriveDistance


def teleop(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


def test_the_sticks_drive_and_turn(control, robot, physics_controller):
    start = physics_controller.get_pose()
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_left_y(-1)
        teleop(control, 1)
        assert physics_controller.get_pose().relative_to(start).x > 0.8
        assert robot.container.drive.distance() > 0.8

        gamepad.set_left_y(0)
        gamepad.set_right_x(-0.5)  # to the left
        teleop(control, 0.5)
        assert physics_controller.get_pose().rotation().degrees() > 10
        assert robot.container.drive.heading() > 10

        believed, really = robot.container.drive.field.get_robot_pose(), physics_controller.get_pose()
        assert believed.translation().distance(really.translation()) < 0.05


@pytest.mark.parametrize("metres", [-1.0, 0.3, 3.0])
def test_a_distance_is_driven_and_the_command_ends(control, robot, physics_controller, metres):
    start = physics_controller.get_pose()
    with control.run_robot():
        teleop(control, 0.1)
        command = DriveDistance(robot.container.drive, metres)
        command.schedule()
        teleop(control, 6)
        assert not command.is_scheduled()
        assert physics_controller.get_pose().relative_to(start).x == pytest.approx(metres, abs=0.05)


def test_the_x_button_backs_off(control, robot, physics_controller):
    start = physics_controller.get_pose()
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        gamepad.set_x_button(True)
        teleop(control, 0.1)
        gamepad.set_x_button(False)
        teleop(control, 3)
        assert physics_controller.get_pose().relative_to(start).x == pytest.approx(-0.5, abs=0.05)
