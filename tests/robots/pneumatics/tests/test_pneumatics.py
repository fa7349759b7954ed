"""What the sensors say to the robot, and what the robot says to its valves."""

import pytest

OPEN_GRIPPER, SHIFT, BRAKE = 1, 2, 3


def test_gripper_closes_once_when_touched(control, robot, hal_data):
    """The switch is pressed twice, opened in between by the driver: two grips."""
    seen = {}

    def on_step(tm):
        hal_data["dio"][2]["value"] = not (1.0 <= tm < 2.0 or 3.0 <= tm < 4.0)
        hal_data["joysticks"][0]["buttons"][OPEN_GRIPPER] = 2.5 <= tm < 2.6
        seen[round(tm, 2)] = (hal_data["solenoid"][0]["value"], hal_data["solenoid"][1]["value"])
        return tm < 5

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    # Forward and reverse valve of the double solenoid.
    assert seen[1.0] == (False, True)
    assert seen[1.02] == (True, False)
    assert seen[2.4] == (True, False)
    assert seen[2.8] == (False, True)
    assert seen[4.5] == (True, False)
    assert robot.grips == 2


def test_both_modules_are_in_the_tree(control, hal_data):
    """Module 0 is CTRE's, module 1 is REV's; 'solenoid' is another name for module 0."""
    seen = {}

    def on_step(tm):
        buttons = hal_data["joysticks"][0]["buttons"]
        buttons[SHIFT] = tm >= 1.0
        buttons[BRAKE] = 2.0 <= tm < 2.1 or 3.0 <= tm < 3.1
        seen[round(tm, 2)] = (hal_data["pcm"][0][2]["value"], hal_data["pcm"][1][0]["value"])
        assert hal_data["solenoid"][2]["value"] == hal_data["pcm"][0][2]["value"]
        return tm < 4

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert seen[0.5] == (False, False)
    assert seen[1.5] == (True, False)
    assert seen[2.5] == (True, True)
    assert seen[3.5] == (True, False)


def test_autonomous_lifts_to_half_a_metre(control, hal_data):
    """The lift climbs one count on each packet on which its motor turns."""

    def on_step(tm):
        if hal_data["pwm"][0]["value"] > 0:
            hal_data["encoder"][0]["count"] += 1
        return tm < 5

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert hal_data["encoder"][0]["count"] == 50
    assert hal_data["pwm"][0]["value"] == 0.0
    assert hal_data["pcm"][1][0]["value"]


def test_analog_sensors(control, robot, hal_data):
    """Half of the voltage is half of the potentiometer's turn; the gyro reads in degrees."""

    def on_step(tm):
        hal_data["analog_in"][0]["voltage"] = 2.5
        hal_data["robot"]["adxrs450_spi_0_angle"] = 90.0
        return tm < 0.5

    control.run_test(on_step)

    assert robot.wrist.get() == pytest.approx(135.0, abs=0.5)
    assert robot.gyro.getAngle() == pytest.approx(90.0)
