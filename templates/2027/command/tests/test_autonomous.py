"""The autonomous choices on the dashboard."""

import pytest
from ntcore.util import SelectableControl
from wpilib.simulation import DIOSim, PWMMotorControllerSim


def autonomous(control, seconds):
    control.step_timing(seconds=seconds, autonomous=True, enabled=True)


def choose(control, name):
    """Choose on the dashboard before the match, as drivers do."""
    dashboard = SelectableControl("Autonomous")
    dashboard.set_selected(name)
    control.step_timing(seconds=0.1, autonomous=True, enabled=False)


def test_without_a_choice_it_drives_two_metres(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        autonomous(control, 6)
    assert physics_controller.get_pose().relative_to(start).x == pytest.approx(2.0, abs=0.05)


def test_fetch_comes_back_with_the_intake_off(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        choose(control, "Fetch")
        autonomous(control, 1)
        assert PWMMotorControllerSim(2).get_throttle() > 0.5
        DIOSim(4).set_value(False)
        autonomous(control, 10)
        assert PWMMotorControllerSim(2).get_throttle() == 0
        assert physics_controller.get_pose().relative_to(start).x == pytest.approx(0, abs=0.1)


def test_nothing_is_nothing(control, robot, physics_controller):
    start = physics_controller.get_pose()
    with control.run_robot():
        choose(control, "Nothing")
        autonomous(control, 3)
    assert physics_controller.get_pose().relative_to(start).x == pytest.approx(0, abs=0.001)


def test_teleop_takes_over(control, robot):
    with control.run_robot():
        autonomous(control, 0.5)
        assert robot.autonomous_command.is_scheduled()
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        assert not robot.autonomous_command.is_scheduled()
