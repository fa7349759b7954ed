"""What the buttons and the autonomous command group do to the arm."""

import pytest
from wpilib import XboxController
from wpilib.simulation import PWMSim

A, B, X = XboxController.Button.kA, XboxController.Button.kB, XboxController.Button.kX


def test_autonomous_steps_take_their_time(control, robot, hal_data):
    """Up for a second, a second's wait, down for half a second: note when each step starts."""
    started = {}
    speeds = []

    def on_step(tm):
        for step in robot.log:
            started.setdefault(step, tm)
        speeds.append(hal_data["pwm"][0]["value"])
        return tm < 5

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert robot.log == ["up", "wait", "down", "done"]
    # The scheduler needs one loop of 20 ms more to go on from one command to the next.
    assert started["wait"] - started["up"] == pytest.approx(1.0)
    assert started["down"] - started["wait"] == pytest.approx(1.02)
    assert started["done"] - started["down"] == pytest.approx(0.52)
    # A command moves the motor from its second loop on: one less than 50 and 25.
    assert speeds.count(0.5) == 49
    assert speeds.count(-0.5) == 24
    assert speeds[-1] == 0.0


def test_buttons_move_the_arm_while_held(control, hal_data):
    """Hold A for a second, then B for half a second."""
    speeds = []

    def on_step(tm):
        buttons = hal_data["joysticks"][0]["buttons"]
        buttons[A] = 1.0 <= tm < 2.0
        buttons[B] = 2.5 <= tm < 3.0
        speeds.append(hal_data["pwm"][0]["value"])
        return tm < 4

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert speeds.count(0.5) == 50
    assert speeds.count(-0.5) == 25
    assert speeds[-1] == 0.0


def test_raise_stops_at_the_limit_switch(control, robot, hal_data):
    """One press of X is enough; the switch ends the command, and it counts once."""
    speeds = {}

    def on_step(tm):
        hal_data["joysticks"][0]["buttons"][X] = 1.0 <= tm < 1.1
        hal_data["dio"][0]["value"] = tm < 2.0
        speeds[round(tm, 2)] = hal_data["pwm"][0]["value"]
        return tm < 3

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert speeds[1.5] == 1.0
    assert speeds[2.5] == 0.0
    assert sum(value > 0 for value in speeds.values()) == 50
    assert robot.arm.raised == 1


def test_teleop_cancels_autonomous(control, robot):
    """Today's style: the driver takes over while the arm is still moving up."""
    with control.run_robot():
        arm = PWMSim(0)
        control.step_timing(seconds=0.5, autonomous=True, enabled=True)
        assert arm.getSpeed() == 0.5
        assert robot.log == ["up"]

        control.step_timing(seconds=2.0, autonomous=False, enabled=True)
        assert arm.getSpeed() == 0.0
        assert robot.log == ["up"]
