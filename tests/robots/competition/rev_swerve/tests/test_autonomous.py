"""The autonomous modes arrive where they should."""

import pytest
import wpilib
from commands2 import CommandScheduler
from wpimath.geometry import Translation2d


@pytest.mark.parametrize(("auto", "goal"), [("ShootAndCollect", (1.9, 5.2)), ("Leave", (6.0, 1.5))])
def test_arrives(control, hal_data, robot, physics_controller, auto, goal):
    hal_data["alliance_station"] = "blue1"
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=True, enabled=False)
        wpilib.SmartDashboard.putString("Auto/selected", auto)
        control.step_timing(seconds=0.5, autonomous=True, enabled=False)
        control.step_timing(seconds=15, autonomous=True, enabled=True)
        pose = physics_controller.get_pose()
        assert pose.translation().distance(Translation2d(*goal)) < 0.2
        estimated = robot.container.drivetrain.pose()
        assert estimated.translation().distance(pose.translation()) < 0.1
        assert abs((estimated.rotation() - pose.rotation()).degrees()) < 2


def test_shoots_two_pieces(control, hal_data, robot):
    hal_data["alliance_station"] = "blue2"
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=True, enabled=False)
        assert robot.container.shooter.has_piece()
        control.step_timing(seconds=15, autonomous=True, enabled=True)
        assert wpilib.SmartDashboard.getNumber("Sim/Shots", 0) == 2


def test_teleop_ends_it(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=2, autonomous=True, enabled=True)
        command = robot.autonomous_command
        assert command.isScheduled()
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        assert not CommandScheduler.getInstance().isScheduled(command)
