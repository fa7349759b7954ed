"""What the drive team relies on: it drives, it lifts, and it knows where it is."""

import math

from constants import Drive, Positions

DRIVER, OPERATOR = 0, 1


def press(hal_data, gamepad, button, pressed=True):
    """Press or release a button."""
    hal_data["joysticks"][gamepad]["buttons"][button] = pressed


def test_drives_forward(control, hal_data, robot, physics_controller):
    """Two seconds of full stick are some metres, and the estimator follows."""
    start = physics_controller.get_pose()
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        hal_data["joysticks"][DRIVER]["axes"][1] = -1.0
        control.step_timing(seconds=2, autonomous=False, enabled=True)
        pose = physics_controller.get_pose()
        assert 2.0 < pose.relativeTo(start).X() < 8.0
        estimated = robot.container.drivetrain.pose()
        assert estimated.translation().distance(pose.translation()) < 0.3


def test_autonomous_leaves(control, robot, physics_controller):
    """The default routine drives two metres and turns."""
    with control.run_robot():
        control.step_timing(seconds=1, autonomous=True, enabled=False)
        control.step_timing(seconds=9, autonomous=True, enabled=True)
        pose = physics_controller.get_pose()
        assert abs(pose.X() - Drive.START.X() - 2.0) < 0.2
        assert abs(pose.rotation().degrees() - 90) < 10


def test_goes_to_the_high_position_and_back(control, hal_data, robot):
    """The elevator finds its lower end, goes up, and comes down; the arm follows."""
    with control.run_robot():
        container = robot.container
        control.step_timing(seconds=2, autonomous=False, enabled=True)
        assert container.elevator.homed
        for button, (metres, degrees, _) in ((4, Positions.HIGH), (3, Positions.STOW)):
            press(hal_data, OPERATOR, button)
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            press(hal_data, OPERATOR, button, False)
            control.step_timing(seconds=4, autonomous=False, enabled=True)
            assert abs(container.elevator.height() - metres) < 0.04
            assert abs(math.degrees(container.arm.angle()) - degrees) < 6


def test_intake_until_the_sensor_sees_a_piece(control, hal_data, robot):
    """The rollers stop and the gripper closes."""
    hal_data["joysticks"][DRIVER]["axes"][3] = 1.0
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        assert hal_data["pwm"][3]["value"] > 0.5
        hal_data["dio"][9]["value"] = False
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        assert hal_data["pwm"][3]["value"] == 0
        assert robot.container.gripper.has_piece()


def test_cameras_correct_the_pose(control, robot, physics_controller):
    """A robot that was put down a little beside its start finds out where it is."""
    with control.run_robot():
        control.step_timing(seconds=3, autonomous=False, enabled=False)
        true_pose = physics_controller.get_pose()
        estimated = robot.container.drivetrain.pose()
        assert robot.container.vision.accepted > 10
        assert estimated.translation().distance(true_pose.translation()) < 0.1
