"""Our own tests: the driver moves the sticks, and the motors follow.

`hal_data` has the robot's inputs and outputs, `control` is the driver station.
"""

import pytest
from ntcore.util import SelectableControl
from wpilib.simulation import PWMMotorControllerSim


def test_autonomous_drives_for_two_seconds(control, hal_data, fake_time):
    """Record the times at which the left motor was on, once for each packet of the driver station."""
    times = []

    def on_step(tm):
        if hal_data["pwm"][0]["value"] > 0:
            times.append(fake_time.get())
        return tm < 5  # go on until 5 seconds have passed

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert times[-1] - times[0] == pytest.approx(2.0, abs=0.05)


def test_nothing_moves_in_autonomous_if_stay_is_chosen(control, hal_data, robot):
    with control.run_robot():
        SelectableControl("Autonomous").set_selected("Stay")
        control.step_timing(seconds=0.1, autonomous=True, enabled=False)  # chosen before the match
        for _ in range(20):
            control.step_timing(seconds=0.1, autonomous=True, enabled=True)
            assert [hal_data["pwm"][channel]["value"] for channel in range(4)] == [0, 0, 0, 0]


def test_sticks_forward_drives_forward(control, hal_data):
    """Both sticks forward: the right side is inverted, so its motors turn the other way."""

    def on_step(tm):
        hal_data["joysticks"][0]["axes"][1] = -1.0
        hal_data["joysticks"][1]["axes"][1] = -1.0
        return tm < 1

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert [hal_data["pwm"][channel]["value"] for channel in range(4)] == [1.0, 1.0, -1.0, -1.0]


def test_encoder_measures_a_turn_of_the_wheel(control, robot, hal_data):
    """360 counts are one turn: 15 cm times pi."""

    def on_step(tm):
        hal_data["encoder"][0]["count"] = 360
        return tm < 1

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert robot.left_encoder.get_distance() == pytest.approx(0.471, abs=0.001)


def test_disabled_robot_stands_still(control):
    """The same without on_step: the test advances the time and reads WPILib's own classes."""
    with control.run_robot():
        control.step_timing(seconds=1, autonomous=True, enabled=True)
        assert PWMMotorControllerSim(0).get_throttle() == pytest.approx(0.5, abs=0.02)

        control.step_timing(seconds=1, autonomous=True, enabled=False)
        assert PWMMotorControllerSim(0).get_throttle() == 0.0
        assert control.robot_is_alive
