"""What the timed robot does in each mode, loop by loop."""

import pytest
from wpilib.simulation import DriverStationSim, PWMSim


def test_practice_match_runs_each_mode_once(control, robot):
    """A match is 15 s of autonomous and 135 s of teleop, in loops of 20 ms."""
    control.set_practice_match()
    control.run_test()

    assert robot.autonomous.entered == 1
    assert robot.autonomous.loops == 750
    assert robot.teleop.entered == 1
    assert robot.teleop.loops == 6750


def test_autonomous_drives_two_seconds_then_turns_one(control, hal_data):
    """Collect what the motors were told on every packet, and count."""
    seen = []

    def on_step(tm):
        seen.append((round(hal_data["pwm"][0]["value"], 1), round(hal_data["pwm"][1]["value"], 1)))
        return tm < 5

    control.game_specific_message = "LRL"
    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    # The right motor is inverted: forward is negative for it.
    assert seen.count((0.5, -0.5)) == 100
    # To the left: the left side backward, the right side forward.
    assert seen.count((-0.5, -0.5)) == 50
    assert seen[-1] == (0.0, 0.0)


def test_stick_drives_the_motors_on_the_same_packet(control, hal_data):
    """The driver pushes the stick half forward from 1 s to 2 s: (0.5 less the deadband) squared."""
    seen = {}

    class Driver:
        """Moves the stick, and notes what the left motor was told so far."""

        def on_step(self, tm):
            """Called once for each packet."""
            seen[round(tm, 2)] = hal_data["pwm"][0]["value"]
            hal_data["joysticks"][0]["axes"][1] = -0.5 if 1.0 <= tm < 2.0 else 0.0
            return tm < 3

    control.set_operator_control(enabled=True)
    control.run_test(Driver)

    assert seen[1.0] == 0.0
    assert seen[1.02] == pytest.approx(0.24, abs=0.01)
    assert seen[2.0] == pytest.approx(0.24, abs=0.01)
    assert seen[2.02] == 0.0
    assert sum(value > 0 for value in seen.values()) == 50


def test_enable_and_disable(control, robot):
    """Today's style: the test itself moves the time on."""
    with control.run_robot():
        left = PWMSim(0)
        DriverStationSim.setJoystickAxisCount(0, 2)

        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        assert robot.disabled.entered == 1
        assert left.getSpeed() == 0.0

        DriverStationSim.setJoystickAxis(0, 1, -1.0)
        control.step_timing(seconds=1.0, autonomous=False, enabled=True)
        assert robot.teleop.entered == 1
        loops = robot.teleop.loops
        # The answer is the time that really passed, should it be a little more than was asked for.
        seconds = control.step_timing(seconds=2.0, autonomous=False, enabled=True)
        assert robot.teleop.loops - loops == round(seconds / 0.02)
        assert left.getSpeed() == 1.0

        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        assert robot.disabled.entered == 2
        assert left.getSpeed() == 0.0
        assert control.robot_is_alive
