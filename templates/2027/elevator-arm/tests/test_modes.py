"""Changes from one mode to another."""

import pytest
from wpilib.simulation import PWMMotorControllerSim, XboxControllerSim

from robot import STOWED, TOP


def test_autonomous_reaches_up_and_folds_up_again(control, robot):
    with control.run_robot():
        control.step_timing(seconds=3.9, autonomous=True, enabled=True)
        assert robot.elevator.height == pytest.approx(TOP[0], abs=0.02)
        assert robot.arm.angle == pytest.approx(TOP[1], abs=0.03)
        control.step_timing(seconds=4, autonomous=True, enabled=True)
        assert robot.elevator.height == pytest.approx(STOWED[0], abs=0.02)
        assert robot.arm.angle == pytest.approx(STOWED[1], abs=0.03)


def test_a_disabled_robot_lets_go_and_later_holds_what_it_has(control, robot):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        gamepad.set_y_button(True)
        control.step_timing(seconds=3, autonomous=False, enabled=True)
        assert robot.elevator.height > 1.2

        control.step_timing(seconds=0.3, autonomous=False, enabled=False)
        assert [PWMMotorControllerSim(channel).get_throttle() for channel in (0, 1)] == [0, 0]
        sunk = robot.elevator.height

        gamepad.set_y_button(False)
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        assert robot.elevator.height == pytest.approx(sunk, abs=0.1)


def test_the_dashboard_shows_both(control, robot):
    with control.run_robot():
        control.step_timing(seconds=3.9, autonomous=True, enabled=True)
        assert robot.elevator_line.get_length() == pytest.approx(0.3 + TOP[0], abs=0.03)
        assert robot.arm_line.get_angle() == pytest.approx(60 - 90, abs=3)
