"""The elevator and the arm move to the driver's position and hold it."""

import math

import pytest
from wpilib.simulation import PWMSim, XboxControllerSim

from robot import FLOOR, SHELF, STOWED, TOP


def teleop(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


def press(control, set_button):
    """Press a button of the gamepad briefly."""
    gamepad = XboxControllerSim(0)
    set_button(gamepad, True)
    teleop(control, 0.06)
    set_button(gamepad, False)


@pytest.mark.parametrize(
    ("set_button", "place"),
    [
        (XboxControllerSim.setAButton, FLOOR),
        (XboxControllerSim.setBButton, SHELF),
        (XboxControllerSim.setYButton, TOP),
        (XboxControllerSim.setXButton, STOWED),
    ],
)
def test_a_button_brings_both_there_and_holds_them(control, robot, set_button, place):
    height, angle = place
    with control.run_robot():
        teleop(control, 0.1)
        press(control, XboxControllerSim.setBButton)
        teleop(control, 1)
        press(control, set_button)
        teleop(control, 3)
        for _ in range(50):
            assert robot.elevator.height == pytest.approx(height, abs=0.02)
            assert robot.arm.angle == pytest.approx(angle, abs=0.03)
            teleop(control, 0.02)
        assert robot.elevator.is_there
        assert robot.arm.is_there


def test_the_elevator_never_leaves_its_ends(control, robot):
    with control.run_robot():
        teleop(control, 0.1)
        robot.elevator.go_to(5)
        robot.arm.go_to(5)
        teleop(control, 4)
        assert robot.elevator.height == pytest.approx(1.4, abs=0.02)
        assert robot.arm.angle == pytest.approx(math.radians(85), abs=0.03)


def test_at_the_bottom_the_motor_pulls_no_further(control, robot):
    with control.run_robot():
        teleop(control, 0.1)
        assert not robot.elevator.bottom_switch.get()
        press(control, XboxControllerSim.setXButton)
        for _ in range(50):
            teleop(control, 0.02)
            assert PWMSim(0).getSpeed() >= 0


def test_it_overshoots_little(control, robot):
    with control.run_robot():
        teleop(control, 0.1)
        press(control, XboxControllerSim.setYButton)
        heights, angles = [], []
        for _ in range(200):
            teleop(control, 0.02)
            heights.append(robot.elevator.height)
            angles.append(robot.arm.angle)
        height, angle = TOP
        assert max(heights) < height + 0.05
        assert max(angles) < angle + 0.1
