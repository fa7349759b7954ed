"""What can be chosen on the dashboard for autonomous."""

import pytest
from wpilib.simulation import DIOSim, PWMSim, SendableChooserSim


def autonomous(control, seconds):
    control.step_timing(seconds=seconds, autonomous=True, enabled=True)


def choose(control, name):
    """Choose on the dashboard, as drivers do: some time before the match."""
    dashboard = SendableChooserSim("/SmartDashboard/Autonomous/")
    dashboard.setSelected(name)
    control.step_timing(seconds=0.1, autonomous=True, enabled=False)


def test_without_a_choice_it_drives_two_metres(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        autonomous(control, 6)
    assert physics_controller.get_pose().relativeTo(start).X() == pytest.approx(2.0, abs=0.05)


def test_fetch_comes_back_with_the_intake_off(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        choose(control, "Fetch")
        autonomous(control, 1)
        assert PWMSim(2).getSpeed() > 0.5
        DIOSim(4).setValue(False)
        autonomous(control, 10)
        assert PWMSim(2).getSpeed() == 0
        assert physics_controller.get_pose().relativeTo(start).X() == pytest.approx(0, abs=0.1)


def test_nothing_is_nothing(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        choose(control, "Nothing")
        autonomous(control, 3)
    assert physics_controller.get_pose().relativeTo(start).X() == pytest.approx(0, abs=0.001)


def test_teleop_takes_over(control, robot):
    with control.run_robot():
        autonomous(control, 0.5)
        assert robot.autonomous_command.isScheduled()
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        assert not robot.autonomous_command.isScheduled()
