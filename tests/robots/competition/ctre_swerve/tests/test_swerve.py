"""The team's own tests: its geometry, its bindings, its autonomous routines.

CTRE simulates its devices in real time, so distances differ a little from run to run.
"""

import pytest
from wpilib.simulation import XboxControllerSim
from wpimath.kinematics import ChassisSpeeds

from commands import autos
from constants import Elevator, Swerve


def test_two_pieces_is_the_default(robot):
    """All routines are built, and one of them is chosen when the dashboard chooses none."""
    assert robot.container.autonomous_command().getName() == "Two pieces"


def test_modules_are_at_the_corners(robot):
    """Turning in place rolls all wheels equally fast."""
    states = robot.container.drivetrain.kinematics.toSwerveModuleStates(ChassisSpeeds(0, 0, 1))
    assert [abs(state.speed) for state in states] == pytest.approx([Swerve.LOCATIONS[0].norm()] * 4)


def test_leave_drives_over_the_line(control, robot, physics_controller):
    """The robot really moves, and knows where it is."""
    robot.container.autonomous_command = lambda: autos.leave(robot.container.drivetrain)
    with control.run_robot():
        control.step_timing(seconds=4, autonomous=True, enabled=True)
        pose = robot.container.drivetrain.pose()
        assert pose.x - autos.START.x == pytest.approx(2, abs=0.3)
        assert pose.translation().distance(physics_controller.get_pose().translation()) < 0.3


def test_driver_stick_reaches_the_modules(control, robot):
    """A stick asks each module for its speed."""
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        XboxControllerSim(0).setLeftY(-1)
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        velocities = [module.velocity_request.velocity for module in robot.container.drivetrain.modules]
        assert all(abs(velocity) > 1 for velocity in velocities), velocities


def test_operator_raises_the_elevator(control, robot):
    """The highest goal, and the carriage leaves the bottom."""
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        XboxControllerSim(1).setYButton(True)
        control.step_timing(seconds=2, autonomous=False, enabled=True)
        assert robot.container.elevator.goal == pytest.approx(Elevator.SCORE_HIGH)
        assert robot.container.elevator.height() > 0.5
