"""Sleeping takes robot time, every clock agrees on it, and nobody waits for it."""

import pytest


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
