"""Shooting: nothing is fed before the wheel is fast enough."""

import pytest
from wpilib.simulation import PWMSim, XboxControllerSim


def teleop(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


def test_feeds_when_the_wheel_is_up_to_speed(control, robot):
    gamepad, feeder = XboxControllerSim(0), PWMSim(3)
    with control.run_robot():
        gamepad.setAButton(True)
        teleop(control, 0.1)
        assert PWMSim(2).getSpeed() == 1.0
        assert feeder.getSpeed() == 0

        while feeder.getSpeed() == 0:
            teleop(control, 0.02)
        assert robot.shooter.wheel_speed() == pytest.approx(60, abs=3)


def test_a_shot_that_has_begun_is_finished(control, robot):
    gamepad, feeder = XboxControllerSim(0), PWMSim(3)
    with control.run_robot():
        gamepad.setAButton(True)
        while feeder.getSpeed() == 0:
            teleop(control, 0.02)
        gamepad.setAButton(False)
        teleop(control, 0.3)
        assert feeder.getSpeed() == 1.0
        teleop(control, 0.5)
        assert feeder.getSpeed() == 0
        assert PWMSim(2).getSpeed() == 0


def test_the_speed_can_be_changed_on_the_dashboard(control, robot):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        robot.shooter.speed = 30.0
        gamepad.setAButton(True)
        teleop(control, 3)
        assert robot.shooter.wheel_speed() == pytest.approx(30, abs=3)
