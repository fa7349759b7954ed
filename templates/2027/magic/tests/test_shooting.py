"""Shooting: the feeder waits until the wheel is fast enough."""

import pytest
from wpilib.simulation import XboxControllerSim

WHEEL, FEEDER = 2, 3  # the channels of the motors


def teleop(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


def test_feeds_when_the_wheel_is_up_to_speed(control, hal_data, robot):
    gamepad, motors = XboxControllerSim(0), hal_data["pwm"]
    with control.run_robot():
        gamepad.set_a_button(True)
        teleop(control, 0.1)
        assert motors[WHEEL]["value"] == 1.0
        assert motors[FEEDER]["value"] == 0

        while motors[FEEDER]["value"] == 0:
            teleop(control, 0.02)
        assert robot.shooter.wheel_speed() == pytest.approx(60, abs=3)


def test_a_shot_that_has_begun_is_finished(control, hal_data, robot):
    gamepad, motors = XboxControllerSim(0), hal_data["pwm"]
    with control.run_robot():
        gamepad.set_a_button(True)
        while motors[FEEDER]["value"] == 0:
            teleop(control, 0.02)
        gamepad.set_a_button(False)
        teleop(control, 0.3)
        assert motors[FEEDER]["value"] == 1.0
        teleop(control, 0.5)
        assert motors[FEEDER]["value"] == 0
        assert motors[WHEEL]["value"] == 0


def test_the_speed_can_be_changed_on_the_dashboard(control, robot):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        robot.shooter.speed = 30.0
        gamepad.set_a_button(True)
        teleop(control, 3)
        assert robot.shooter.wheel_speed() == pytest.approx(30, abs=3)
