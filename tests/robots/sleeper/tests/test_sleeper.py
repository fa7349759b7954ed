"""Sleeping takes robot time, every clock agrees on it, and nobody waits for it."""

import pytest
from wpilib.simulation import PWMSim


def test_every_clock_measures_one_second(control, robot):
    """Two times half a second, by five clocks."""
    control.set_autonomous(enabled=True)
    control.run_test(lambda tm: tm < 3)

    assert set(robot.measured) == {"monotonic", "time", "perf_counter", "monotonic_ns", "fpga"}
    assert list(robot.measured.values()) == pytest.approx([1.0] * 5, abs=1e-6)


def test_packets_arrive_while_the_robot_sleeps(control, hal_data):
    """The driver station goes on: 25 packets see the robot drive, 25 see it turn."""
    seen = []

    def on_step(tm):
        seen.append((hal_data["pwm"][0]["value"], hal_data["pwm"][1]["value"]))
        return tm < 3

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert seen.count((0.5, 0.5)) == 25
    assert seen.count((0.5, -0.5)) == 25
    assert seen[-1] == (0.0, 0.0)


def test_loops_go_on_after_the_sleep(control, robot):
    """The loops slept through are not made up for: 50 a second from then on."""
    loops = {}

    def on_step(tm):
        loops[round(tm, 2)] = robot.autonomous_loops
        return tm < 4

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert loops[1.0] == 0
    assert loops[3.0] - loops[2.0] == 50
    assert loops[4.0] - loops[2.0] == 100


def test_monotonic_is_robot_time(control, hal_data):
    """100 loops of driving are two seconds for time.monotonic()."""
    seen = []

    def on_step(tm):
        seen.append(hal_data["pwm"][0]["value"])
        return tm < 4

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert seen.count(1.0) == 100


def test_sleep_inside_the_block(control, robot):
    """Today's style: the robot runs in place, so a step lasts at least as long as the robot sleeps in it."""
    with control.run_robot():
        # The first loop begins at 0.02 s and sleeps for a second, through the end of this step.
        assert control.step_timing(seconds=0.3, autonomous=True, enabled=True) == pytest.approx(1.02)
        assert PWMSim(0).getSpeed() == 0.0
        assert robot.measured["time"] == pytest.approx(1.0, abs=1e-6)
        assert control.robot_is_alive
