"""Several tests in a row, each of which must find the devices as if it were the first."""

import pytest
from wpilib.simulation import EncoderSim, PWMSim


@pytest.mark.parametrize("attempt", [1, 2, 3])
def test_each_run_starts_from_zero(control, robot, hal_data, attempt):
    """The motor is left running and the encoder counted: the next attempt must not see it."""
    assert robot.starts == 0
    assert hal_data["pwm"][0]["value"] == 0.0
    assert hal_data["encoder"][0]["count"] == 0

    def on_step(tm):
        hal_data["encoder"][0]["count"] = 7
        return tm < 1

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert robot.starts == 1
    assert robot.motor.get() == 0.5
    assert robot.encoder.getDistance() == 3.5


def test_autonomous_stops_after_ten_metres(control, hal_data):
    """Two metres every packet: the motor is seen running on five of them."""
    running = []

    def on_step(tm):
        running.append(hal_data["pwm"][0]["value"] > 0)
        if running[-1]:
            hal_data["encoder"][0]["count"] += 4
        return tm < 1

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert running.count(True) == 5
    assert hal_data["encoder"][0]["count"] == 20
    assert hal_data["pwm"][0]["value"] == 0.0


def test_devices_were_created_on_import(robot, hal_data):
    """The robot was not started here: its devices are there all the same."""
    assert robot.starts == 0
    assert hal_data["pwm"][0]["initialized"]
    assert hal_data["encoder"][0]["initialized"]


@pytest.mark.parametrize("attempt", [1, 2])
def test_todays_style_starts_from_zero_as_well(control, robot, attempt):
    """The same with WPILib's simulation classes."""
    with control.run_robot():
        motor, encoder = PWMSim(0), EncoderSim(robot.encoder)
        assert motor.getSpeed() == 0.0
        assert encoder.getCount() == 0

        encoder.setCount(19)
        control.step_timing(seconds=0.5, autonomous=True, enabled=True)
        assert motor.getSpeed() == 0.5
        encoder.setCount(20)
        control.step_timing(seconds=0.1, autonomous=True, enabled=True)
        assert motor.getSpeed() == 0.0
        encoder.setCount(0)
        control.step_timing(seconds=0.1, autonomous=True, enabled=True)
        assert motor.getSpeed() == 0.5
        assert robot.starts == 1
