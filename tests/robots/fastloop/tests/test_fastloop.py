"""The three rates, in numbers of calls."""

import pytest


def test_three_rates(control, robot):
    """In ten seconds: 500 loops, 1000 odometry sums, 2000 controller steps."""
    calls = {}

    def on_step(tm):
        calls[round(tm, 2)] = (robot.slow_loops, robot.odometry_loops, robot.control_loops)
        return tm < 11

    control.run_test(on_step)

    slow, odometry, fast = (late - early for early, late in zip(calls[1.0], calls[11.0], strict=True))
    assert slow == 500
    assert fast == 2000
    # WPILib's notifier rounds its alarms down to the microsecond: one may fall just before a packet.
    assert odometry == pytest.approx(1000, abs=1)


def test_odometry_sums_what_the_encoder_counts(control, robot, hal_data):
    """Ten counts a packet for two seconds, then back by half of them."""

    def on_step(tm):
        encoder = hal_data["encoder"][0]
        if 1.0 <= tm < 3.0:
            encoder["count"] += 10
        elif 3.0 <= tm < 4.0:
            encoder["count"] -= 10
        return tm < 5

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert hal_data["encoder"][0]["count"] == 500
    assert hal_data["encoder"][0]["distance_per_pulse"] == pytest.approx(0.001)
    assert robot.last_distance == pytest.approx(0.5)
    assert robot.travelled == pytest.approx(1.5)
    # Up to 1 m in 2 s, down to 0.5 m in 1 s, and there for another: 1 + 0.75 + 0.5.
    assert robot.metre_seconds == pytest.approx(2.25, abs=0.05)


def test_controller_drives_to_the_target(control, hal_data):
    """Full speed while far away, half of the error's double near it, zero at it."""
    seen = {}

    def on_step(tm):
        seen[round(tm, 2)] = hal_data["pwm"][0]["value"]
        if tm >= 2.0:
            hal_data["encoder"][0]["count"] = 1000
        elif tm >= 1.0:
            hal_data["encoder"][0]["count"] = 750
        return tm < 3

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert seen[1.0] == 1.0
    assert seen[1.5] == pytest.approx(0.5, abs=0.005)
    assert seen[2.5] == 0.0
